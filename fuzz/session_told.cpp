// What a world tells by its getters, as one number; and whether queries find what it tells of.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "fuzz/session.h"

namespace avbd::fuzz {
namespace {

/// FNV-1a (Fowler, Noll, Vo) over values without gaps.
class Digest {
 public:
  template <class... T>
  void take(const T&... values) {
    (one(values), ...);
  }
  uint64_t value() const { return value_; }

 private:
  template <class T>
  void one(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001b3u;
  }
  void one(const Vec3& v) { take(v.x, v.y, v.z); }
  void one(const Vec3d& v) { take(v.x, v.y, v.z); }
  void one(const Quat& q) { take(q.w, q.x, q.y, q.z); }
  void one(const Pose& p) { take(p.position, p.rotation); }
  void one(const SymMat3& m) { take(m.xx, m.yy, m.zz, m.xy, m.xz, m.yz); }
  void one(const BodyId& id) { take(id.index, id.generation); }
  void one(const ShapeId& id) { take(id.index, id.generation); }
  void one(const JointId& id) { take(id.index, id.generation); }
  void one(const Filter& f) { take(f.category, f.mask, f.group, f.anyMask); }
  void one(const Material& m) {
    take(m.friction, m.staticFriction, m.restitution, m.frictionCombine, m.restitutionCombine, m.frictionPriority,
         m.torsionalFriction, m.rollingFriction);
  }
  void one(const D6Axis& a) {
    take(a.motion, a.limit.lower, a.limit.upper, a.limit.stiffness, a.limit.damping, a.limit.restitution,
         a.drive.stiffness, a.drive.damping, a.drive.position, a.drive.velocity, a.drive.maxForce, a.drive.acceleration,
         a.drive.force, a.friction, a.spring.stiffness, a.spring.damping, a.spring.position, a.armature, a.maxVelocity);
  }
  void one(const Geometry& g) {
    take(g.index());
    if (const auto* s = std::get_if<Sphere>(&g)) take(s->radius);
    if (const auto* s = std::get_if<Capsule>(&g)) take(s->radius, s->halfHeight);
    if (const auto* s = std::get_if<Box>(&g)) take(s->x, s->y, s->z, s->rounding);
    if (const auto* s = std::get_if<Cylinder>(&g)) take(s->radius, s->halfHeight, s->rounding);
    if (const auto* s = std::get_if<Cone>(&g)) take(s->radius, s->halfHeight, s->rounding);
    if (const auto* s = std::get_if<Ellipsoid>(&g)) take(s->x, s->y, s->z);
    if (const auto* s = std::get_if<Hull>(&g)) take(s->scale, s->rounding, s->data->contentHash());
    if (const auto* s = std::get_if<Mesh>(&g)) take(s->scale, s->data->contentHash());
    if (const auto* s = std::get_if<HeightField>(&g)) take(s->scale, s->data->contentHash());
  }

  uint64_t value_ = 0xcbf29ce484222325u;
};

std::vector<D6Axis> axesOf(const World& world, JointId id) {
  const auto one = [](const auto& def) {
    return std::vector<D6Axis>{
        {AxisMotion::Free, def.limit, def.drive, def.friction, def.spring, def.armature, def.maxVelocity}};
  };
  if (world.type(id) == JointType::Hinge) return one(world.hingeJoint(id));
  if (world.type(id) == JointType::Slider) return one(world.sliderJoint(id));
  if (world.type(id) == JointType::Coupling) return {world.coupling(id).axis};
  if (world.type(id) != JointType::D6) return {};
  const D6Joint def = world.d6Joint(id);
  return {def.axes.begin(), def.axes.end()};
}

float least(Vec3 v) { return std::min({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

/// A point well inside a convex geometry, and how far its surface is from there at least; 0: not convex.
struct Inner {
  Vec3d point;
  double depth = 0;
};
Inner innerOf(const Geometry& g) {
  if (const auto* s = std::get_if<Sphere>(&g)) return {{}, s->radius};
  if (const auto* s = std::get_if<Capsule>(&g)) return {{}, s->radius};
  if (const auto* s = std::get_if<Box>(&g)) return {{}, least({s->x, s->y, s->z})};
  if (const auto* s = std::get_if<Cylinder>(&g)) return {{}, std::min(s->radius, s->halfHeight)};
  // From the middle of the axis the side is at least 0.44 of the smaller one away.
  if (const auto* s = std::get_if<Cone>(&g)) return {{}, 0.25 * std::min(s->radius, s->halfHeight)};
  if (const auto* s = std::get_if<Ellipsoid>(&g)) return {{}, least({s->x, s->y, s->z})};
  if (const auto* s = std::get_if<Hull>(&g)) {
    const Vec3 c = s->data->center(), k = s->scale;
    return {toDouble(Vec3{c.x * k.x, c.y * k.y, c.z * k.z}), s->data->innerRadius() * least(k)};
  }
  return {};
}

double most(Vec3d v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

}  // namespace

uint64_t Session::told() const {
  Digest digest;
  const WorldDef& def = world_.definition();
  digest.take(def.gravity, def.iterations, def.substeps, world_.time());
  for (const BodyId id : bodies_) {
    const Velocity v = world_.velocity(id);
    digest.take(world_.type(id), world_.pose(id), v.linear, v.angular, world_.mass(id), world_.inertia(id),
                world_.centerOfMass(id), world_.userData(id));
    digest.take(world_.linearDamping(id), world_.angularDamping(id), world_.gravityScale(id), world_.locks(id),
                world_.iterations(id), world_.maxLinearSpeed(id), world_.maxAngularSpeed(id));
    for (const ShapeId shape : world_.shapes(id)) digest.take(shape);
  }
  for (const ShapeId id : shapes_) {
    digest.take(world_.body(id), world_.geometry(id), world_.localPose(id), world_.material(id), world_.filter(id),
                world_.isTrigger(id), world_.contactEvents(id), world_.hitEvents(id), world_.contactHook(id),
                world_.userData(id));
    for (const Material& material : world_.materials(id)) digest.take(material);
  }
  for (const JointId id : joints_) {
    const JointBreak breaks = world_.breakLimits(id);
    digest.take(world_.type(id), world_.gap(id), world_.userData(id), world_.isEnabled(id), breaks.force,
                breaks.torque);
    for (const D6Axis& axis : axesOf(world_, id)) digest.take(axis);
  }
  for (const BodyId id : world_.bodies()) digest.take(id);
  for (const JointId id : world_.joints()) digest.take(id);
  for (const auto& pair : world_.excludedPairs()) digest.take(pair[0], pair[1]);
  for (const Contact& contact : world_.contacts()) digest.take(contact.shapeA, contact.shapeB, contact.pointCount);
  return digest.value();
}

/// Each convex shape answers for a point well inside of it: the tree is fitted and nothing is missed.
void Session::checkFound() const {
  constexpr double kMostPosition = 1e9;
  const double unit = static_cast<double>(world_.definition().lengthUnit);
  for (const ShapeId id : shapes_) {
    const Inner inner = innerOf(world_.geometry(id));
    const Filter filter = world_.filter(id);
    if (world_.isTrigger(id) || filter.mask == 0 || filter.category == 0) continue;
    const Pose body = world_.pose(world_.body(id)), local = world_.localPose(id);
    const Vec3d point = (body * local).position + rotate((body * local).rotation, inner.point);
    // Offsets within a body are floats, positions doubles.
    const double rounding =
        4e-6 * (length(local.position) + length(world_.centerOfMass(world_.body(id))) + length(inner.point)) +
        1e-15 * length(point);
    if (!(inner.depth > 2 * rounding) || most(point) + 20 * unit > kMostPosition * unit) continue;
    const QueryFilter all{.filter = {.category = 0xffffffffu}};
    const auto isIn = [&](const auto& found) { return std::find(found.begin(), found.end(), id) != found.end(); };
    require(isIn(world_.containing(point, all)), "a shape that does not hold its inner point");
    const float tiny = static_cast<float>(1e-3 * unit);
    require(isIn(world_.overlaps(Sphere{tiny}, {point, {}}, all)), "a shape that a ball within does not overlap");
    // The ray's direction is in floats, too.
    if (!(inner.depth > rounding + 4e-6 * unit)) continue;
    const Vec3d start = point + Vec3d{0.3, 10, -0.7} * unit;
    const std::vector<CastHit> hits =
        world_.rayAll({start, toFloat(point - start), static_cast<float>(11 * unit)}, all);
    require(std::any_of(hits.begin(), hits.end(), [&](const CastHit& hit) { return hit.shape == id; }),
            "a shape that a ray through its inner point does not meet");
  }
}

}  // namespace avbd::fuzz
