// That what a snapshot says fits together: a checksum can be right over anything.
#include <algorithm>
#include <cmath>

#include "world/check.h"
#include "world/joints.h"
#include "world/limits.h"
#include "world/pairs.h"
#include "world/snapshot_parts.h"

namespace avbd::snapshot {
namespace {

constexpr size_t kMostTerms = 8;

bool finite(float x) { return std::isfinite(x); }
bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool isUnit(Quat q) {
  const float size = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return std::abs(size - 1) < 0.01f;
}

void checkBody(const BodyData& body) {
  require(body.type <= BodyType::Dynamic, "a body of no type");
  require(body.locks < 64 && body.iterations >= 0 && body.iterations <= kMaxIterations, "a body's setting");
  require(finite(body.position) && isUnit(body.rotation), "a body's pose");
  require(finite(body.last.position) && isUnit(body.last.rotation), "where a body was");
  require(finite(body.linearVelocity) && finite(body.angularVelocity) && finite(body.acceleration), "a body's motion");
  require(finite(body.force) && finite(body.torque) && finite(body.center), "a body's forces");
  require(finite(body.radius) && finite(body.minExtent) && body.radius >= 0 && body.minExtent >= 0, "a body's size");
  require(finite(body.mass) && (body.type == BodyType::Dynamic ? body.mass > 0 : body.mass == 0), "a body's mass");
}

void checkShape(const WorldData& data, uint32_t slot) {
  const ShapeData& shape = data.shapes[slot];
  require(data.bodyIds.isAliveSlot(shape.body), "a shape of no body");
  require(finite(shape.local.position) && isUnit(shape.local.rotation), "a shape's pose");
  require(finite(shape.toMass.p) && isUnit(shape.toMass.q), "a shape's place");
  const Aabb& box = data.tree.box(shape.proxy);
  require(box.lower.x <= box.upper.x && box.lower.y <= box.upper.y && box.lower.z <= box.upper.z, "a shape's bounds");
  const Path path("World::restore"), whole = path / "snapshot", shapes = whole / "shapes", one = shapes[slot];
  checkMayMove(one, shape.geometry, data.bodies[shape.body].type);
  checkMaterial(one / "material", shape.material);
  if (!shape.materials.empty() || isSurface(shape.geom.type))
    checkMaterials(one / "materials", shape.materials, shape.geometry);
}

/// Every shape is in the list of its body and in no other.
void checkShapeLists(const WorldData& data) {
  size_t left = data.shapeIds.count();
  data.bodyIds.forEach([&](uint32_t body) {
    for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next) {
      require(data.shapeIds.isAliveSlot(s) && data.shapes[s].body == body && left > 0, "a body's list of shapes");
      --left;
    }
  });
  require(left == 0, "a shape that no body lists");
}

void checkJointBodies(const WorldData& data, uint32_t slot, size_t& links) {
  const JointData& joint = data.joints[slot];
  const int count = bodyCount(data, slot);
  require(joint.type != JointType::Custom || (count >= 1 && count <= 4), "a joint of too few or too many bodies");
  bool moves = joint.type == JointType::Coupling;
  for (int i = 0; i < 4; ++i) {
    if (joint.body[i] == kNone) {
      require(joint.type != JointType::TetVolume, "a volume of too few bodies");
      continue;
    }
    require(i < count && data.bodyIds.isAliveSlot(joint.body[i]), "a joint of a body that there is not");
    for (int k = 0; k < i; ++k) require(joint.body[k] != joint.body[i], "a joint of one body twice");
    moves = moves || data.bodies[joint.body[i]].type == BodyType::Dynamic;
    ++links;
  }
  require(moves, "a joint that nothing moves");
  require(joint.type != JointType::Custom || data.links[slot].family, "a joint of no family");
  for (int i = 0; i < 2; ++i)
    require(finite(joint.frame[i].position) && isUnit(joint.frame[i].rotation) && isUnit(joint.axes[i]),
            "a joint's frame");
}

void checkAxes(const WorldData& data, uint32_t slot) {
  const JointData& joint = data.joints[slot];
  if (isD6(joint.type)) {
    require(data.d6[slot].turned <= 2, "a joint's order of axes");
    for (const D6Axis& axis : data.d6[slot].axis) require(axis.motion <= AxisMotion::Free, "an axis of no motion");
  }
  if (joint.type != JointType::Coupling) return;
  require(!data.links[slot].terms.empty() && data.links[slot].terms.size() <= kMostTerms, "a coupling's terms");
  for (const LinkTerm& term : data.links[slot].terms)
    require(
        data.jointIds.isAliveSlot(term.joint) && isD6(data.joints[term.joint].type) && term.axis <= JointAxis::SwingZ,
        "a coupling of a joint that there is not");
}

/// Every joint is in the lists of its bodies and in no others.
void checkJointLists(const WorldData& data, size_t links) {
  data.bodyIds.forEach([&](uint32_t body) {
    for (uint32_t s = data.bodies[body].firstJoint; s != kNone;) {
      require(data.jointIds.isAliveSlot(s) && links > 0, "a body's list of joints");
      const JointData& joint = data.joints[s];
      const int side = sideOf(joint, body);
      require(joint.body[side] == body, "a body's list of joints");
      s = joint.next[side];
      --links;
    }
  });
  require(links == 0, "a joint that a body does not list");
}

/// What joints exclude is excluded, as often as they do.
void checkExcluded(const WorldData& data) {
  const std::vector<uint64_t>& all = data.excludedPairs;
  require(std::is_sorted(all.begin(), all.end()), "the order of excluded pairs");
  for (const uint64_t pair : all) {
    const auto low = static_cast<uint32_t>(pair >> 32), high = static_cast<uint32_t>(pair);
    require(low < high && data.bodyIds.isAliveSlot(low) && data.bodyIds.isAliveSlot(high), "an excluded pair");
  }
  std::vector<uint64_t> byJoints;
  data.jointIds.forEach([&](uint32_t slot) {
    const JointData& joint = data.joints[slot];
    if (!excludes(joint)) return;
    const uint64_t low = std::min(joint.body[0], joint.body[1]), high = std::max(joint.body[0], joint.body[1]);
    byJoints.push_back(low << 32 | high);
  });
  std::sort(byJoints.begin(), byJoints.end());
  require(std::includes(all.begin(), all.end(), byJoints.begin(), byJoints.end()), "a joint's excluded pair");
}

void checkSlots(const std::vector<uint32_t>& slots, size_t count) {
  require(slots.empty() || slots.back() < count, "a list of shapes that there are not");
  require(std::adjacent_find(slots.begin(), slots.end(), std::greater_equal<>()) == slots.end(), "a list's order");
}

void checkLiving(const PairSide& a, const PairSide& b, const PairData& pair) {
  require(a.body == pair.bodyA && b.body == pair.bodyB && a.body != b.body, "a pair's bodies");
  require(a.isConvex || b.isConvex, "a pair of two surfaces");
  require(pair.hasSurface == (a.isSurface || b.isSurface), "a pair's kind");
  require(pair.isTrigger == (a.isTrigger || b.isTrigger) && pair.triggerIsA == a.isTrigger, "a pair's trigger");
  require(pair.isTrigger || a.isDynamic || b.isDynamic, "a pair that nothing moves");
}

bool lives(const WorldData& data, const PairData& pair) {
  return data.shapeIds.isAlive(pair.shapeId(0)) && data.shapeIds.isAlive(pair.shapeId(1)) &&
         (data.forgotten.empty() || (!isForgotten(data, pair.shapeA) && !isForgotten(data, pair.shapeB)));
}

}  // namespace

void checkLinks(const WorldData& data) {
  data.bodyIds.forEach([&](uint32_t slot) { checkBody(data.bodies[slot]); });
  data.shapeIds.forEach([&](uint32_t slot) { checkShape(data, slot); });
  require(data.tree.size() == data.shapeIds.count(), "a leaf of the tree without shape");
  checkShapeLists(data);
  size_t links = 0;
  data.jointIds.forEach([&](uint32_t slot) { checkJointBodies(data, slot, links), checkAxes(data, slot); });
  checkJointLists(data, links);
  checkExcluded(data);
  checkSlots(data.unpaired, data.shapes.size());
  checkSlots(data.forgotten, data.shapes.size());
}

void checkPair(const WorldData& data, const PairSides& sides, const PairData& pair, const PairData* before) {
  const bool goesOn = before && before->key() == pair.key();
  require(pair.shapeA < pair.shapeB && (!before || before->key() <= pair.key()), "the order of pairs");
  require(pair.patch == (goesOn ? before->patch + 1 : 0) && (!goesOn || pair.hasSurface), "a pair's run");
  if (lives(data, pair))
    checkLiving(sides[pair.shapeA], sides[pair.shapeB], pair);
  else
    require(isForgotten(data, pair.shapeA) || isForgotten(data, pair.shapeB), "a pair of shapes that are gone");
}

}  // namespace avbd::snapshot
