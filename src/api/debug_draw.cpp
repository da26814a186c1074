// The world's parts in a fixed order: bodies by slot with their shapes, joints, contacts.
#include <avbd/debug_draw.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include "api/debug_shapes.h"
#include "world/check.h"
#include "world/limits.h"

namespace avbd {
namespace {

constexpr DebugColor kStatic = 0xff7f8791, kKinematic = 0xff4e8fd0, kDynamic = 0xffe8a04c, kTrigger = 0x6033cc66;
constexpr DebugColor kBounds = 0xff909090, kContact = 0xffffc531, kForce = 0xffff5a36, kNormal = 0xff3ddc5a;
constexpr DebugColor kJoint = 0xff27c4e8, kGap = 0xffff2d6f, kCenter = 0xffffffff, kVelocity = 0xffb06cff;
constexpr float kPointSize = 6;

void check(const DebugDrawOptions& o) {
  const Path at("DebugDrawOptions");
  check(at / "segments", o.segments, {4, 256});
  check(at / "size", o.size, notNegative(1e6));
  check(at / "planeHalf", o.planeHalf, positive(1e6));
  check(at / "lengthPerNewton", o.lengthPerNewton, notNegative(1e6));
  check(at / "lengthPerSpeed", o.lengthPerSpeed, notNegative(1e6));
  check(at / "origin", o.origin, symmetric(1e12));
}

DebugColor colorOf(BodyType type) {
  return type == BodyType::Static ? kStatic : type == BodyType::Kinematic ? kKinematic : kDynamic;
}

/// Colours that neighbours in number do not share.
DebugColor colorOf(uint32_t number) {
  const uint32_t mixed = (number + 1) * 2654435761u;  // Knuth's multiplicative hash
  return 0xff404040u | (mixed >> 8 & 0x00bfbfbfu);
}

void draw(const Geometry& geometry, const Pose& pose, DebugColor color, DebugSink& sink,
          const DebugDrawOptions& options) {
  const DebugPen pen{sink, options, color, {pose.rotation, toFloat(pose.position - options.origin)}};
  if (options.wire) drawWire(pen, geometry);
  if (options.solid) drawSolid(pen, geometry);
}

class Drawing {
 public:
  Drawing(const World& world, DebugSink& sink, const DebugDrawOptions& options)
      : world_(world), sink_(sink), o_(options), bodies_(world.bodies()) {
    if (o_.islands) findIslands();
  }

  void all() {
    for (size_t i = 0; i < bodies_.size(); ++i) body(i);
    if (o_.joints)
      for (const JointId id : world_.joints()) joint(id);
    if (o_.contacts)
      for (const Contact& c : world_.contacts()) contact(c);
  }

 private:
  Vec3 near(Vec3d p) const { return toFloat(p - o_.origin); }

  void body(size_t i) {
    const BodyId id = bodies_[i];
    const Pose pose = world_.pose(id);
    DebugColor color = colorOf(world_.type(id));
    if (o_.islands && world_.type(id) == BodyType::Dynamic) color = colorOf(rootOf(static_cast<uint32_t>(i)));
    for (const ShapeId shape : world_.shapes(id)) drawShape(shape, pose, color);
    const Vec3 center = near(world_.worldCenterOfMass(id));
    if (o_.centersOfMass && world_.type(id) == BodyType::Dynamic) {
      for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        const Vec3 arm = o_.size * rotate(pose.rotation, axis);
        sink_.line(center - arm, center + arm, kCenter);
      }
    }
    if (o_.velocities && world_.type(id) != BodyType::Static) {
      const Vec3 v = world_.velocity(id).linear;
      if (!(v == Vec3{})) sink_.line(center, center + o_.lengthPerSpeed * v, kVelocity);
    }
    if (o_.bodyIds) sink_.text(near(pose.position), std::to_string(id.index), color);
  }

  void drawShape(ShapeId shape, const Pose& body, DebugColor color) {
    const bool trigger = world_.isTrigger(shape);
    if (trigger && !o_.triggers) return;
    const Geometry geometry = world_.geometry(shape);
    const Pose pose = body * world_.localPose(shape);
    draw(geometry, pose, trigger ? kTrigger : color, sink_, o_);
    if (o_.bounds) drawBounds(geometry, pose);
  }

  void drawBounds(const Geometry& geometry, const Pose& pose) {
    const Quat back = conjugate(pose.rotation);
    std::array<float, 3> low{}, high{};
    const std::array<Vec3, 3> axes{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Vec3 p = near(pose.position);
    const std::array<float, 3> middle{p.x, p.y, p.z};
    for (size_t i = 0; i < 3; ++i) {
      const Vec3 d = rotate(back, axes[i]);
      float up, down;
      if (!farthest(geometry, d, up) || !farthest(geometry, -d, down)) return;
      low[i] = middle[i] - down;
      high[i] = middle[i] + up;
    }
    const auto corner = [&](unsigned k) {
      return Vec3{k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]};
    };
    for (unsigned k = 0; k < 8; ++k)
      for (const unsigned bit : {1u, 2u, 4u})
        if ((k & bit) == 0) sink_.line(corner(k), corner(k | bit), kBounds);
  }

  void joint(JointId id) {
    const JointType type = world_.type(id);
    if (type == JointType::TetVolume || type == JointType::Coupling || type == JointType::Custom) return between(id);
    const auto [a, b] = ends(id);
    const BodyId bodyA = sides(id)[0], bodyB = sides(id)[1];
    if (bodyA) sink_.line(near(world_.worldCenterOfMass(bodyA)), a, kJoint);
    if (bodyB) sink_.line(near(world_.worldCenterOfMass(bodyB)), b, kJoint);
    if (type == JointType::Pulley) {
      const PulleyJoint pulley = world_.pulleyJoint(id);
      sink_.line(a, near(pulley.wheelA), kJoint), sink_.line(b, near(pulley.wheelB), kJoint);
      return;
    }
    sink_.line(a, b, type == JointType::Distance ? kJoint : kGap);
    sink_.point(a, kPointSize, kJoint);
  }

  std::array<Vec3, 2> ends(JointId id) const {
    const std::array<Pose, 2> frames = world_.worldFrames(id);
    return {near(frames[0].position), near(frames[1].position)};
  }

  /// A's and B's body; null for the world.
  std::array<BodyId, 2> sides(JointId id) const {
    const auto of = [](const auto& def) { return std::array{def.bodyA, def.bodyB}; };
    switch (world_.type(id)) {
      case JointType::Ball:
        return of(world_.ballJoint(id));
      case JointType::Fixed:
        return of(world_.fixedJoint(id));
      case JointType::Hinge:
        return of(world_.hingeJoint(id));
      case JointType::Slider:
        return of(world_.sliderJoint(id));
      case JointType::D6:
        return of(world_.d6Joint(id));
      case JointType::Distance:
        return of(world_.distanceJoint(id));
      default:
        return of(world_.pulleyJoint(id));
    }
  }

  /// What has no frames: a line between each two of its bodies.
  void between(JointId id) {
    const std::vector<BodyId> bodies = world_.bodies(id);
    for (size_t i = 0; i < bodies.size(); ++i)
      for (size_t k = i + 1; k < bodies.size(); ++k)
        sink_.line(near(world_.worldCenterOfMass(bodies[i])), near(world_.worldCenterOfMass(bodies[k])), kJoint);
  }

  void contact(const Contact& c) {
    for (int i = 0; i < c.pointCount; ++i) {
      const ContactPoint& point = c.points[static_cast<size_t>(i)];
      const Vec3 p = near(point.position);
      sink_.point(p, kPointSize, kContact);
      sink_.line(p, p + o_.size * c.normal, kNormal);
      const Vec3 force = point.normalForce * c.normal + point.frictionForce;
      if (!(force == Vec3{})) sink_.line(p, p + o_.lengthPerNewton * force, kForce);
    }
  }

  // Dynamic bodies joined by contacts that carry force and by joints: union-find over places in bodies_, the lowest
  // place is the root.
  void findIslands() {
    roots_.resize(bodies_.size());
    std::iota(roots_.begin(), roots_.end(), 0u);
    for (const Contact& c : world_.contacts()) {
      const auto end = c.points.begin() + c.pointCount;
      if (std::any_of(c.points.begin(), end, [](const ContactPoint& p) { return p.normalForce > 0; }))
        unite(c.bodyA, c.bodyB);
    }
    for (const JointId id : world_.joints()) {
      const std::vector<BodyId> bodies = world_.isEnabled(id) ? world_.bodies(id) : std::vector<BodyId>{};
      for (const BodyId body : bodies) unite(bodies[0], body);
    }
  }

  void unite(BodyId a, BodyId b) {
    for (const BodyId id : {a, b})
      if (!id || !world_.isAlive(id) || world_.type(id) != BodyType::Dynamic) return;
    const uint32_t i = rootOf(placeOf(a)), k = rootOf(placeOf(b));
    roots_[std::max(i, k)] = std::min(i, k);
  }
  uint32_t placeOf(BodyId id) const {
    const auto at =
        std::lower_bound(bodies_.begin(), bodies_.end(), id, [](BodyId x, BodyId y) { return x.index < y.index; });
    return static_cast<uint32_t>(at - bodies_.begin());
  }
  uint32_t rootOf(uint32_t place) const {
    while (roots_[place] != place) place = roots_[place];
    return place;
  }

  const World& world_;
  DebugSink& sink_;
  const DebugDrawOptions& o_;
  std::vector<BodyId> bodies_;  // in order of their slots
  std::vector<uint32_t> roots_;
};

}  // namespace

void debugDraw(const Geometry& geometry, const Pose& pose, DebugColor color, DebugSink& sink,
               const DebugDrawOptions& options) {
  check(options);
  const Path call("debugDraw");
  // What a world of any unit may hold.
  checkGeometry(call / "geometry", geometry, Range{kMinSize * kMinUnit, kMaxSize * kMaxUnit});
  draw(geometry, checkedPose(call / "pose", pose, kMaxPosition * kMaxUnit), color, sink, options);
}

void debugDraw(const World& world, DebugSink& sink, const DebugDrawOptions& options) {
  check(options);
  Drawing(world, sink, options).all();
}

void DebugLists::clear() {
  lines.clear();
  triangles.clear();
  points.clear();
  texts_.clear();
  characters_.clear();
}

DebugLists::Text DebugLists::text(size_t i) const {
  const Place& place = texts_.at(i);
  return {place.position, std::string_view(characters_.data() + place.first, place.count), place.color};
}

void DebugLists::line(Vec3 from, Vec3 to, DebugColor color) {
  lines.push_back({from, color});
  lines.push_back({to, color});
}

void DebugLists::triangle(Vec3 a, Vec3 b, Vec3 c, DebugColor color) {
  for (const Vec3 corner : {a, b, c}) triangles.push_back({corner, color});
}

void DebugLists::point(Vec3 position, float size, DebugColor color) { points.push_back({position, size, color}); }

void DebugLists::text(Vec3 position, std::string_view text, DebugColor color) {
  texts_.push_back({position, color, static_cast<uint32_t>(characters_.size()), static_cast<uint32_t>(text.size())});
  characters_.insert(characters_.end(), text.begin(), text.end());
}

}  // namespace avbd
