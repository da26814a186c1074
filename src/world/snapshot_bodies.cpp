// Snapshots: bodies.
#include "world/snapshot_parts.h"

namespace avbd::snapshot {
namespace {

/// What a body is expected to be: like the one before, with the next shape.
BodyData after(const BodyData& before) {
  BodyData expected = before;
  if (expected.firstShape != kNone) ++expected.firstShape;
  return expected;
}

template <class Codec, class World>
void code(Codec& codec, World& data) {
  BodyData expected;
  data.bodyIds.forEach([&](uint32_t slot) {
    codec.record(data.bodies[slot], expected);
    expected = after(data.bodies[slot]);
  });
}

}  // namespace

void codeBodies(Writer& out, const WorldData& data) { code(out, data); }

void codeBodies(Reader& in, WorldData& data) {
  require(data.bodyIds.count() <= in.left(), "more bodies than bytes");
  data.bodies.resize(data.bodyIds.slotCount());
  for (uint32_t slot = 0; slot < data.bodies.size(); ++slot)
    if (!data.bodyIds.isAliveSlot(slot)) data.bodies[slot] = {};
  code(in, data);
}

}  // namespace avbd::snapshot
