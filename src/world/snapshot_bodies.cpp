// Snapshots: bodies.
#include "world/snapshot_near.h"
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

// Where contacts were last looked for: about where its velocity brings a body back to, or where it is.

/// More than any takes.
constexpr size_t kLastBytes = 64;

Pose expectedLast(const WorldData& data, const BodyData& body) {
  if (body.asleep) return {body.position, body.rotation};
  const float h = data.lastSubstep;
  const Vec3 back = body.angularVelocity * (-0.5f * h);
  const Quat turn = Quat{0, back.x, back.y, back.z} * body.rotation, now = body.rotation;
  return {body.position - body.linearVelocity * h, {now.w + turn.w, now.x + turn.x, now.y + turn.y, now.z + turn.z}};
}

void writeLast(Writer& out, const WorldData& data, const BodyData& body) {
  std::byte* const head = out.room(kLastBytes);
  std::byte* to = head + 1;
  const Pose expected = expectedLast(data, body);
  const Quat &now = body.last.rotation, &near = expected.rotation;
  const uint32_t position = putNear(to, body.last.position, expected.position);
  const uint32_t rotation = putNear<4>(to, {now.w, now.x, now.y, now.z}, {near.w, near.x, near.y, near.z});
  *head = static_cast<std::byte>(position | rotation << 2);
  out.advance(to);
}

void readLast(Reader& in, const WorldData& data, BodyData& body) {
  const std::byte* const head = in.piece(kLastBytes);
  const std::byte* from = head + 1;
  const auto ways = static_cast<uint32_t>(*head);
  require(ways < 16, "a body that was in no place");
  const Pose expected = expectedLast(data, body);
  const Quat& near = expected.rotation;
  std::array<float, 4> turn;
  putNear(from, body.last.position, expected.position, ways & 3u);
  putNear<4>(from, turn, {near.w, near.x, near.y, near.z}, ways >> 2);
  body.last.rotation = {turn[0], turn[1], turn[2], turn[3]};
  in.advance(static_cast<size_t>(from - head));
}

}  // namespace

void codeBodies(Writer& out, const WorldData& data) {
  code(out, data);
  data.bodyIds.forEach([&](uint32_t slot) { writeLast(out, data, data.bodies[slot]); });
}

void codeBodies(Reader& in, WorldData& data) {
  require(data.bodyIds.count() <= in.left(), "more bodies than bytes");
  data.bodies.resize(data.bodyIds.slotCount());
  for (uint32_t slot = 0; slot < data.bodies.size(); ++slot)
    if (!data.bodyIds.isAliveSlot(slot)) data.bodies[slot] = {};
  code(in, data);
  data.bodyIds.forEach([&](uint32_t slot) { readLast(in, data, data.bodies[slot]); });
}

}  // namespace avbd::snapshot
