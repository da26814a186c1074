// Figures of a world from its public getters.
#include "scenes/measure.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <unordered_map>

namespace avbd::scenes {
namespace {

uint64_t pairKey(uint32_t a, uint32_t b) { return (static_cast<uint64_t>(std::min(a, b)) << 32) | std::max(a, b); }

using Slots = std::unordered_map<uint32_t, uint32_t>;

Pose place(std::span<const Pose> poses, uint32_t body, const Pose& frame) {
  return body == kWorldBody ? frame : poses[body] * frame;
}

constexpr uint8_t bit(JointAxis axis) { return static_cast<uint8_t>(1u << static_cast<unsigned>(axis)); }
constexpr uint8_t kLinear = 7, kAll = 63;

uint8_t lockedOf(const BallJoint&) { return kLinear; }
uint8_t lockedOf(const FixedJoint&) { return kAll; }
uint8_t lockedOf(const HingeJoint&) { return kAll & ~bit(JointAxis::Twist); }
uint8_t lockedOf(const SliderJoint&) { return kAll & ~bit(JointAxis::LinearX); }
uint8_t lockedOf(const DistanceJoint&) { return 0; }
uint8_t lockedOf(const D6Joint& joint) {
  uint8_t locked = 0;
  for (size_t i = 0; i < 6; ++i)
    if (joint.axes[i].motion == AxisMotion::Locked) locked = static_cast<uint8_t>(locked | 1u << i);
  return locked;
}

uint32_t slotOf(const Slots& slots, BodyId id) { return id ? slots.at(id.index) : kWorldBody; }

template <class Joint>
void addJoint(Layout& layout, const Joint& joint, const Slots& slots) {
  const uint32_t a = slotOf(slots, joint.bodyA), b = slotOf(slots, joint.bodyB);
  Layout::Anchors& to = layout.anchors.emplace_back();
  to = {a,
        b,
        joint.frameA.position,
        joint.frameB.position,
        joint.frameA.rotation,
        joint.frameB.rotation,
        lockedOf(joint),
        false,
        0,
        0};
  if constexpr (std::is_same_v<Joint, DistanceJoint>) to.spans = true, to.shortest = joint.min, to.longest = joint.max;
}

void addRope(Layout& layout, const PulleyJoint& joint, const Slots& slots) {
  layout.ropes.push_back({slotOf(slots, joint.bodyA), slotOf(slots, joint.bodyB), joint.frameA.position,
                          joint.frameB.position, joint.wheelA, joint.wheelB, joint.ratio, joint.length, joint.slack});
}

double gapOf(const Layout::Anchors& j, const Pose& a, const Pose& b) {
  const Vec3d offset = b.position - a.position;
  const double far = length(offset);
  if (j.spans) return std::max({0.0, far - j.longest, j.shortest - far});
  if ((j.locked & kLinear) == kLinear) return far;
  const Vec3d q = rotate(conjugate(a.rotation), offset);
  return length(Vec3d{j.locked & 1 ? q.x : 0, j.locked & 2 ? q.y : 0, j.locked & 4 ? q.z : 0});
}

double gapOf(const Layout::Rope& j, std::span<const Pose> poses) {
  const double a = length(place(poses, j.bodyA, {j.a, {}}).position - j.wheelA);
  const double b = length(place(poses, j.bodyB, {j.b, {}}).position - j.wheelB);
  const double beyond = a + j.ratio * b - j.length;
  return j.slack ? std::max(0.0, beyond) : std::abs(beyond);
}

double angleOf(const Layout::Anchors& j, const Pose& a, const Pose& b) {
  const Quat turn = conjugate(a.rotation) * b.rotation;
  if ((j.locked & ~kLinear) == (kAll & ~kLinear))
    return 2 * std::atan2(length(toDouble({turn.x, turn.y, turn.z})), std::abs(static_cast<double>(turn.w)));
  const TwistSwing q = twistSwing(turn);
  return length(Vec3d{j.locked & 8 ? q.twist : 0, j.locked & 16 ? q.y : 0, j.locked & 32 ? q.z : 0});
}

void raise(double& worst, double value) {
  if (!(value <= worst)) worst = value;  // a NaN is kept
}

Vec3d crossProduct(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

Vec3d spin(const World& world, BodyId id, Vec3d omega) {
  const Quat q = world.pose(id).rotation;
  const SymMat3 i = world.inertia(id);
  const Vec3d w = rotate(conjugate(q), omega);
  return rotate(q, Vec3d{i.xx * w.x + i.xy * w.y + i.xz * w.z, i.xy * w.x + i.yy * w.y + i.yz * w.z,
                         i.xz * w.x + i.yz * w.y + i.zz * w.z});
}

bool finitePose(const Pose& p) {
  return std::isfinite(p.position.x + p.position.y + p.position.z + p.rotation.w + p.rotation.x + p.rotation.y +
                       p.rotation.z);
}

}  // namespace

bool Layout::mayTouch(uint32_t pieceA, uint32_t pieceB) const {
  const Piece &a = pieces[pieceA], &b = pieces[pieceB];
  if (a.soft && a.soft == b.soft) return false;
  if (!separated.empty() && separated.count(pairKey(a.body, b.body))) return false;
  const Filter &f = a.filter, &g = b.filter;
  if (f.group == g.group && f.group != 0) return f.group > 0;
  const bool ab = (f.category & g.mask) != 0, ba = (g.category & f.mask) != 0;
  return f.anyMask && g.anyMask ? ab || ba : ab && ba;
}

Layout layoutOf(const World& world) {
  Layout layout;
  layout.bodies = world.bodies();
  Slots slots;
  for (const BodyId id : layout.bodies) {
    const uint32_t slot = static_cast<uint32_t>(slots.size());
    slots[id.index] = slot;
    layout.dynamic.push_back(world.type(id) == BodyType::Dynamic);
    for (const ShapeId s : world.shapes(id))
      layout.pieces.push_back({slot, world.geometry(s), world.localPose(s), world.filter(s), world.softBody(id)});
  }
  for (const auto& [a, b] : world.excludedPairs())
    layout.separated.insert(pairKey(slots.at(a.index), slots.at(b.index)));
  for (const JointId id : world.joints()) {
    if (!world.isEnabled(id)) continue;
    if (world.type(id) == JointType::Ball) addJoint(layout, world.ballJoint(id), slots);
    if (world.type(id) == JointType::Fixed) addJoint(layout, world.fixedJoint(id), slots);
    if (world.type(id) == JointType::Hinge) addJoint(layout, world.hingeJoint(id), slots);
    if (world.type(id) == JointType::Slider) addJoint(layout, world.sliderJoint(id), slots);
    if (world.type(id) == JointType::D6) addJoint(layout, world.d6Joint(id), slots);
    if (world.type(id) == JointType::Distance) addJoint(layout, world.distanceJoint(id), slots);
    if (world.type(id) == JointType::Pulley) addRope(layout, world.pulleyJoint(id), slots);
  }
  return layout;
}

std::vector<Pose> posesOf(const World& world, const Layout& layout) {
  std::vector<Pose> poses(layout.bodies.size());
  world.getPoses(layout.bodies, poses);
  return poses;
}

Penetration penetrationOf(const Layout& layout, std::span<const Pose> poses) {
  std::vector<PlacedShape> placed;
  placed.reserve(layout.pieces.size());
  for (const Layout::Piece& p : layout.pieces)
    placed.push_back({p.geometry, poses[p.body] * p.pose, p.body, layout.dynamic[p.body] != 0});
  return measurePenetration(placed, [&](uint32_t a, uint32_t b) { return layout.mayTouch(a, b); });
}

double jointGapMax(const Layout& layout, std::span<const Pose> poses) {
  double worst = 0;
  for (const Layout::Anchors& j : layout.anchors)
    raise(worst, gapOf(j, place(poses, j.bodyA, {j.a, j.frameA}), place(poses, j.bodyB, {j.b, j.frameB})));
  for (const Layout::Rope& j : layout.ropes) raise(worst, gapOf(j, poses));
  return worst;
}

double jointAngleMax(const Layout& layout, std::span<const Pose> poses) {
  double worst = 0;
  for (const Layout::Anchors& j : layout.anchors)
    raise(worst, angleOf(j, place(poses, j.bodyA, {j.a, j.frameA}), place(poses, j.bodyB, {j.b, j.frameB})));
  return worst;
}

TwistSwing twistSwing(Quat q) {
  const double twist = 2 * std::atan2(q.w < 0 ? -q.x : q.x, std::abs(static_cast<double>(q.w)));
  const Vec3d b = rotate(q, Vec3d{1, 0, 0});
  const double sine = std::hypot(b.y, b.z), angle = std::atan2(sine, b.x), g = sine > 1e-12 ? angle / sine : 1;
  return {twist, -g * b.z, g * b.y};
}

Displacement displacement(const Layout& layout, std::span<const Pose> from, std::span<const Pose> to) {
  Displacement worst;
  for (size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.dynamic[i]) continue;
    const Vec3d d = to[i].position - from[i].position;
    const double total = length(d), horizontal = std::hypot(d.x, d.z);
    raise(worst.total, total);
    raise(worst.horizontal, horizontal);
  }
  return worst;
}

bool isFinite(std::span<const Pose> poses) { return std::all_of(poses.begin(), poses.end(), finitePose); }

bool isFinite(const World& world) {
  for (const BodyId id : world.bodies()) {
    const Velocity v = world.velocity(id);
    if (!finitePose(world.pose(id)) ||
        !std::isfinite(v.linear.x + v.linear.y + v.linear.z + v.angular.x + v.angular.y + v.angular.z))
      return false;
  }
  return true;
}

std::vector<Motion> motionsOf(const World& world) {
  const Vec3d g = toDouble(world.definition().gravity);
  std::vector<Motion> motions;
  for (const BodyId id : world.bodies()) {
    if (world.type(id) != BodyType::Dynamic) continue;
    const Velocity v = world.velocity(id);
    Motion m{id, world.mass(id), -world.mass(id) * dot(g, world.worldCenterOfMass(id)), {}, v};
    const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (size_t i = 0; i < 3; ++i) m.inertia[i] = spin(world, id, axes[i]);
    motions.push_back(m);
  }
  return motions;
}

double energyBetween(std::span<const Motion> motions, const World& world) {
  double sum = 0;
  for (const Motion& m : motions) {
    const Velocity leaving = world.velocity(m.body);
    const Vec3d v = (toDouble(m.coming.linear) + toDouble(leaving.linear)) * 0.5;
    const Vec3d w = (toDouble(m.coming.angular) + toDouble(leaving.angular)) * 0.5;
    const Vec3d spun = m.inertia[0] * w.x + m.inertia[1] * w.y + m.inertia[2] * w.z;
    sum += 0.5 * m.mass * dot(v, v) + 0.5 * dot(w, spun) + m.potential;
  }
  return sum;
}

double energy(const World& world) {
  const Vec3d g = toDouble(world.definition().gravity);
  double sum = 0;
  for (const BodyId id : world.bodies()) {
    if (world.type(id) != BodyType::Dynamic) continue;
    const Velocity v = world.velocity(id);
    const Vec3d linear = toDouble(v.linear), angular = toDouble(v.angular);
    sum += 0.5 * world.mass(id) * dot(linear, linear) + 0.5 * dot(angular, spin(world, id, angular)) -
           world.mass(id) * dot(g, world.worldCenterOfMass(id));
  }
  return sum;
}

Momentum momentum(const World& world) {
  Momentum sum;
  for (const BodyId id : world.bodies()) {
    if (world.type(id) != BodyType::Dynamic) continue;
    const Velocity v = world.velocity(id);
    const Vec3d linear = toDouble(v.linear) * static_cast<double>(world.mass(id));
    const Vec3d angular = crossProduct(world.worldCenterOfMass(id), linear) + spin(world, id, toDouble(v.angular));
    sum.linear = sum.linear + linear;
    sum.angular = sum.angular + angular;
    sum.linearScale += length(linear);
    sum.angularScale += length(angular);
  }
  return sum;
}

double speedMax(const World& world) {
  double worst = 0;
  for (const BodyId id : world.bodies()) {
    if (world.type(id) != BodyType::Dynamic) continue;
    const double speed = length(toDouble(world.velocity(id).linear));
    if (!(speed <= worst)) worst = speed;
  }
  return worst;
}

}  // namespace avbd::scenes
