// Hashes of what each stage of a step leaves to the next one (state_hash.h).
#include "world/joints.h"
#include "world/pairs.h"
#include "world/state_hash.h"

namespace avbd {
namespace {

uint64_t pairsHash(const WorldData& data) {
  Hash64 hash;
  data.shapeIds.forEach([&](uint32_t slot) {
    const Aabb& box = data.tree.box(data.shapes[slot].proxy);
    hash.value(box.lower), hash.value(box.upper);
  });
  forEachPair(data, [&](const PairData& pair) { hash.value(pair.key()); });
  return hash.digest();
}

uint64_t contactsHash(const WorldData& data) {
  Hash64 hash;
  forEachPair(data, [&](const PairData& pair) {
    hash.value(pair.key());
    hash.value(pair.pointCount);
    if (pair.hasContact()) hash.value(pair.normal);
    for (int i = 0; i < pair.pointCount; ++i) {
      const PointMemory& point = pair.points[i];
      const ManifoldPoint& place = pair.manifold.points[i];
      hash.value(point.feature);
      hash.value(point.anchorA), hash.value(point.anchorB);
      hash.value(place.position), hash.value(place.separation);
    }
  });
  return hash.digest();
}

void addJoint(Hash64& hash, const WorldData& data, uint32_t slot) {
  const JointData& joint = data.joints[slot];
  hash.value(joint.lambda);
  if (isD6(joint.type)) {
    for (const JointMultipliers& l : data.d6[slot].lambda) addMultipliers(hash, l);
    hash.value(data.d6[slot].coneLambda);
    hash.value(data.d6[slot].slerpLambda);
  }
  if (isLink(joint.type)) addMultipliers(hash, data.links[slot].lambda);
}

uint64_t forcesHash(const WorldData& data) {
  Hash64 hash;
  forEachPair(data, [&](const PairData& pair) {
    for (int i = 0; i < pair.pointCount; ++i) hash.value(pair.points[i].lambda);
    if (pair.torque != Vec3{}) hash.value(pair.torque);
  });
  data.jointIds.forEach([&](uint32_t slot) { addJoint(hash, data, slot); });
  return hash.digest();
}

uint64_t velocitiesHash(const WorldData& data) {
  Hash64 hash;
  data.bodyIds.forEach([&](uint32_t slot) {
    hash.value(data.bodies[slot].linearVelocity);
    hash.value(data.bodies[slot].angularVelocity);
  });
  return hash.digest();
}

/// What is left: poses, what joints and custom rows remember, which points stuck.
uint64_t publishHash(const WorldData& data) {
  Hash64 hash;
  data.bodyIds.forEach([&](uint32_t slot) {
    hash.value(data.bodies[slot].position);
    hash.value(data.bodies[slot].rotation);
  });
  hash.value(stateHash(data));
  return hash.digest();
}

}  // namespace

std::array<uint64_t, kStageCount> stageHashes(const WorldData& data) {
  std::array<uint64_t, kStageCount> hashes{};
  const auto set = [&](Stage stage, uint64_t hash) { hashes[static_cast<size_t>(stage)] = hash; };
  set(Stage::Pairs, pairsHash(data));
  set(Stage::Contacts, contactsHash(data));
  set(Stage::SolveBlocks, forcesHash(data));
  set(Stage::Velocities, velocitiesHash(data));
  set(Stage::Publish, publishHash(data));
  return hashes;
}

}  // namespace avbd
