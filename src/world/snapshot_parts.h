// The sections of a snapshot, in their order. Each is written and read by one text.
#pragma once

#include "world/shared_table.h"
#include "world/snapshot_codec.h"
#include "world/snapshot_fields.h"
#include "world/snapshot_sides.h"
#include "world/world_data.h"

namespace avbd::snapshot {

/// Of the things that a snapshot names their entries in this world's table, by the number in the snapshot.
struct KnownThings {
  SharedTable& table;
  std::vector<uint32_t> entryOf;  ///< kUnknown where the world has none; an Error only for what needs it

  /// The entry of a number in the snapshot. Throws Error for one that this world does not know.
  const SharedTable::Thing& thing(uint32_t number, SharedTable::Kind kind) const;
};
/// All things that shapes and joints have get their numbers.
void numberThings(const WorldData& data, SharedTable& table);

void codeBodies(Writer& out, const WorldData& data);
void codeBodies(Reader& in, WorldData& data);
/// Shapes and the tree. The table must have numbered all things.
void codeShapes(Writer& out, const WorldData& data, SharedTable& table);
void codeShapes(Reader& in, WorldData& data, const KnownThings& things);
void codeJoints(Writer& out, const WorldData& data, SharedTable& table);
void codeJoints(Reader& in, WorldData& data, const KnownThings& things);
/// Soft bodies; their particles must be there.
void codeSofts(Writer& out, const WorldData& data, SharedTable& table);
void codeSofts(Reader& in, WorldData& data, const KnownThings& things);
/// Of soft bodies, once all shapes and lists are there.
void checkSoftContacts(const WorldData& data);
void codePairs(Writer& out, const WorldData& data, const PairSides& sides);
void codePairs(Reader& in, WorldData& data, const PairSides& sides);
void codePairList(Writer& out, const PairSides& sides, const std::vector<PairData>& pairs);
/// Checks each; returns how many means they name.
size_t codePairList(Reader& in, const WorldData& data, const PairSides& sides, std::vector<PairData>& pairs);
/// What is awake, and the islands that sleep with their pairs and joints.
void codeSleep(Writer& out, const WorldData& data, const PairSides& sides);
void codeSleep(Reader& in, WorldData& data, const PairSides& sides);

/// That a snapshot's content fits together: no index, list or flag leads a later call astray. Throws Unsound.
void checkLinks(const WorldData& data);
/// The same of a pair and the one before it, which may be null.
void checkPair(const WorldData& data, const PairSides& sides, const PairData& pair, const PairData* before);
void checkSleep(const WorldData& data);

}  // namespace avbd::snapshot
