// Snapshots of a world's data (avbd/world.h).
#pragma once

#include <cstddef>
#include <span>

#include "world/shared_table.h"
#include "world/snapshot_codec.h"
#include "world/snapshot_sides.h"
#include "world/world_data.h"

namespace avbd {

inline constexpr uint32_t kSnapshotVersion = 5;

/// Everything that the next steps and calls depend on, but for what the user holds: hook, shared geometry, families.
/// `sides` is memory that it uses.
void saveSnapshot(const WorldData& data, SharedTable& table, snapshot::PairSides& sides, snapshot::Writer& out);
/// Fills the head of a snapshot, which leads `whole`.
void sealSnapshot(const WorldData& data, std::span<std::byte> whole);

/// Reads a snapshot into `out`, whose memory is used again; `world` is the one that will take it. Throws Error, with
/// `out` then in no use.
void loadSnapshot(std::span<const std::byte> whole, const WorldData& world, SharedTable& table,
                  snapshot::PairSides& sides, WorldData& out);

}  // namespace avbd
