// Snapshots: refused by Error with the world as it was, or a world that can be used, saved, and restored again.
//
// The first byte says which world the snapshot is of and into which it goes; then either changes to a good snapshot
// follow, or a whole one. Its hash would stop every change, so it is made right again.
#include <avbd/avbd.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "fuzz/bytes.h"
#include "fuzz/check.h"
#include "fuzz/surfaces.h"
#include "src/base/hash.h"

namespace avbd::fuzz {
namespace {

constexpr size_t kHashAt = 32, kHead = 40;

class Spring : public CustomFamily {
 public:
  std::string name() const override { return "spring"; }
  int rowCount() const override { return 1; }
  void evaluate(std::span<const CustomBody> now, std::span<const CustomBody>, float, std::span<const float>,
                std::span<const float>, std::span<CustomRow> rows) const override {
    rows[0].C = now[0].center.y;
    rows[0].linear[0] = {0, 1, 0};
    rows[0].stiffness = 10;
  }
};

void addJoints(World& world, BodyId a, BodyId b) {
  world.create(BallJoint{.bodyA = a, .bodyB = b, .frameA = {{0.5, 0, 0}, {}}, .frameB = {{-0.5, 0, 0}, {}}});
  const JointId hinge = world.create(HingeJoint{.bodyB = a, .frameA = {{0, 3, 0}, {}}, .drive = {.damping = 1}});
  const JointId slider = world.create(SliderJoint{.bodyB = b, .frameA = {{1, 3, 0}, {}}});
  world.create(rackAndPinion(hinge, slider, 0.5f));
  world.create(DistanceJoint{.bodyA = a, .bodyB = b, .max = 2});
  world.create(CustomJoint{.family = std::make_shared<Spring>(), .bodies = {b}, .bodyCount = 1, .memory = {1, 2}});
}

void addSofts(World& world) {
  world.create(SoftDef{.mesh = makeTetBox({0.2f, 0.2f, 0.2f}, 1, 1, 1),
                       .pose = {{0, 0.22, 0}, {}},
                       .material = {.poissonRatio = 0.4999f}});
  world.create(SoftDef{.mesh = makeClothGrid(0.4f, 0.4f, 2, 2),
                       .pose = {{0.05, 0.45, 0.02}, {}},
                       .velocity = {{0, -1, 0}, {}},
                       .material = {.maxStrain = 0.1f}});
}

World make(uint32_t kind) {
  World world({.substeps = kind == 1 ? 2 : 1});
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  if (kind == 2) world.create(BodyDef{.type = BodyType::Static, .position = {0, 0.2, 0}, .shape = Mesh{someMesh()}});
  if (kind == 4) addSofts(world);
  BodyId last{};
  for (int i = 0; i < (kind == 4 ? 1 : 3); ++i) {
    const Geometry shape = i == 1 ? Geometry(Hull{someHull(), {0.5f, 0.4f, 0.5f}}) : Geometry(Box{0.4f, 0.3f, 0.4f});
    const BodyId body = world.create(
        BodyDef{.position = {0.1 * i, 0.6 + 0.7 * i, 0}, .shape = shape, .material = {.restitution = 0.3f}});
    if (i == 2 && kind == 3) addJoints(world, last, body);
    last = body;
  }
  world.create(BodyDef{.type = BodyType::Static, .shapes = {{.geometry = Sphere{1}, .isTrigger = true}}});
  for (int i = 0; i < 6; ++i) world.step(1.0f / 60);
  return world;
}

void seal(std::vector<std::byte>& bytes) {
  if (bytes.size() < kHead) return;
  const uint64_t size = bytes.size();
  std::memcpy(bytes.data() + 16, &size, sizeof(size));
  Hash64 hash;
  hash.bytes(bytes.data(), kHashAt);
  hash.bytes(bytes.data() + kHead, bytes.size() - kHead);
  const uint64_t digest = hash.digest();
  std::memcpy(bytes.data() + kHashAt, &digest, sizeof(digest));
}

/// Changes of bytes, of lengths, and runs of what the input says.
void change(std::vector<std::byte>& bytes, Bytes& in) {
  while (!in.empty()) {
    const uint32_t kind = in.below(8);
    const size_t at = kHead + in.raw<uint16_t>() % (bytes.size() - kHead + 1);
    if (kind == 0 && bytes.size() > kHead + 1) {
      const auto from = bytes.begin() + static_cast<ptrdiff_t>(std::min(at, bytes.size() - 1));
      bytes.erase(from, from + std::min<ptrdiff_t>(in.byte(), bytes.end() - from));
    } else if (kind == 1) {
      bytes.insert(bytes.begin() + static_cast<ptrdiff_t>(at), in.byte(), std::byte{in.byte()});
    } else if (at < bytes.size()) {
      bytes[at] = std::byte{in.byte()};
    }
  }
}

void use(World& world) {
  world.hash(), world.stageHashes();
  for (const Contact& contact : world.contacts())
    require(world.isAlive(contact.shapeA) && world.isAlive(contact.shapeB), "a contact of what is dead");
  for (const JointId joint : world.joints()) world.gap(joint), world.bodies(joint);
  world.rayAll({.origin = {0, 5, 0}, .direction = {0, -1, 0}, .length = 10});
  try {
    for (int i = 0; i < 3; ++i) world.step(1.0f / 60);
    std::vector<std::byte> again;
    world.save(again);
    const uint64_t hash = world.hash();
    world.restore(again);
    require(world.hash() == hash, "what was restored is not what was saved");
    for (const SoftId soft : world.softBodies()) world.destroy(soft);
    const std::vector<BodyId> bodies = world.bodies();
    for (const BodyId body : bodies) world.destroy(body);
    world.step(1.0f / 60);
    require(world.bodyCount() == 0 && world.shapeCount() == 0, "what does not die");
  } catch (const NonFiniteError&) {
  }
}

}  // namespace
}  // namespace avbd::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace avbd;
  using namespace avbd::fuzz;
  if (size == 0) return 0;
  Bytes in(data + 1, size - 1);
  const uint32_t kind = (data[0] & 63) % 5;
  World world = make(kind);
  std::vector<std::byte> bytes;
  world.save(bytes);
  if (data[0] & 64) {
    bytes.resize(kHead);
    for (; !in.empty();) bytes.push_back(std::byte{in.byte()});
  } else {
    change(bytes, in);
  }
  if (!(data[0] & 128)) seal(bytes);
  const uint64_t hash = world.hash();
  try {
    world.restore(bytes);
  } catch (const Error&) {
    require(world.hash() == hash, "a refused snapshot changed the world");
    return 0;
  }
  use(world);
  return 0;
}
