// Bodies, shapes and joints out of bytes.
#include "fuzz/session.h"
#include "fuzz/session_attempt.h"
#include "fuzz/surfaces.h"

namespace avbd::fuzz {
namespace {

constexpr size_t kMostBodies = 24, kMostShapes = 64, kMostJoints = 32;

}  // namespace

Geometry Session::convexGeometry() {
  switch (in_.below(10)) {
    case 0:
      return Sphere{in_.positive()};
    case 1:
      return Capsule{in_.positive(), in_.positive()};
    case 2:
      return Cylinder{in_.positive(), in_.positive(), in_.flag() ? 0 : in_.positive()};
    case 3:
      return Cone{in_.positive(), in_.positive(), in_.flag() ? 0 : in_.positive()};
    case 4:
      return Ellipsoid{in_.positive(), in_.positive(), in_.positive()};
    case 5: {
      const uint8_t which = in_.byte();
      return Hull{which == 0    ? nullptr
                  : which < 128 ? someHull()
                                : roundHull(),
                  in_.flag() ? Vec3{1, 1, 1} : in_.vector(), in_.flag() ? 0 : in_.number()};
    }
    case 6:
      return Box{in_.positive(), in_.positive(), in_.positive(), in_.flag() ? 0 : in_.positive()};
    case 7:
      return Sphere{};
    default:
      return Box{0.5f, 0.5f, 0.5f};
  }
}

Geometry Session::geometry() {
  switch (in_.below(10)) {
    case 0:
      return HalfSpace{};
    case 1: {
      const uint8_t which = in_.byte();
      return Mesh{which == 0    ? nullptr
                  : which < 128 ? someMesh()
                                : thinMesh(),
                  in_.flag() ? Vec3{1, 1, 1} : in_.vector()};
    }
    case 2:
      return HeightField{in_.byte() ? someField() : nullptr, in_.flag() ? Vec3{1, 1, 1} : in_.vector()};
    default:
      return convexGeometry();
  }
}

Material Session::material() {
  Material m;
  if (in_.flag()) return m;
  m.friction = in_.number();
  m.staticFriction = in_.flag() ? -1 : in_.number();
  m.restitution = in_.positive() / 8;
  m.frictionCombine = static_cast<Combine>(in_.below(6));
  m.torsionalFriction = in_.flag() ? 0 : in_.number();
  m.rollingFriction = in_.flag() ? 0 : in_.number();
  return m;
}

Filter Session::filter() {
  if (in_.byte() < 200) return {};
  return {in_.raw<uint32_t>(), in_.raw<uint32_t>(), static_cast<int32_t>(in_.below(4)) - 2, in_.flag()};
}

ShapeDef Session::shapeDef() {
  ShapeDef def;
  def.geometry = geometry();
  if (in_.flag()) def.pose = in_.pose();
  def.density = in_.byte() < 220 ? 1000 : in_.number();
  def.material = material();
  if (in_.byte() > 200) def.materials = {material(), material()};
  def.filter = filter();
  const uint8_t flags = in_.byte();
  def.isTrigger = flags > 220;
  def.hitEvents = flags & 1;
  def.contactHook = flags & 2;
  def.contactEvents = (flags & 12) != 0;
  return def;
}

BodyDef Session::bodyDef() {
  BodyDef def;
  const uint8_t kind = in_.byte();
  def.type = kind < 60    ? BodyType::Static
             : kind < 90  ? BodyType::Kinematic
             : kind < 254 ? BodyType::Dynamic
                          : static_cast<BodyType>(7);
  def.position = in_.position();
  def.rotation = in_.rotation();
  if (in_.flag() && def.type != BodyType::Static) {
    def.linearVelocity = in_.vector();
    def.angularVelocity = in_.vector();
  }
  if (in_.byte() < 230) def.shape = geometry();
  def.material = material();
  def.filter = filter();
  if (in_.byte() > 200) def.shapes.push_back(shapeDef());
  if (in_.byte() > 220) def.mass = in_.number();
  if (in_.byte() > 230)
    def.massProperties =
        MassProperties{in_.number(), in_.vector(), {in_.number(), in_.number(), in_.number(), 0, 0, 0}};
  if (in_.byte() > 220) def.locks = in_.byte();
  if (in_.byte() > 220) def.linearDamping = in_.number();
  if (in_.byte() > 220) def.angularDamping = in_.number();
  if (in_.byte() > 220) def.gravityScale = in_.number();
  return def;
}

BodyId Session::anyBody() {
  const uint8_t pick = in_.byte();
  if (pick > 245) return {};
  if (pick > 235 && !deadBodies_.empty()) return deadBodies_[pick % deadBodies_.size()];
  return bodies_.empty() ? BodyId{} : bodies_[pick % bodies_.size()];
}

ShapeId Session::anyShape() {
  const uint8_t pick = in_.byte();
  if (pick > 235 && !deadShapes_.empty()) return deadShapes_[pick % deadShapes_.size()];
  return shapes_.empty() ? ShapeId{} : shapes_[pick % shapes_.size()];
}

void Session::make() {
  const bool shapeOnly = in_.byte() > 180;
  attempt([&] {
    if (shapeOnly) {
      const BodyId body = anyBody();
      const ShapeDef def = shapeDef();
      if (shapes_.size() >= kMostShapes) return;
      shapes_.push_back(world_.create(body, def));
      if (!def.contactEvents) silent_.insert(shapes_.back());
    } else {
      const BodyDef def = bodyDef();
      if (bodies_.size() >= kMostBodies) return;
      add(def);
      if (!def.shapes.empty() && !def.shapes[0].contactEvents) silent_.insert(shapes_.back());
    }
  });
}

/// Small ones: each particle is a body. What is made is destroyed again now and then, since nothing else may destroy
/// it.
void Session::makeSoft() {
  constexpr size_t kMostSofts = 3;
  attempt([&] {
    if (softs_.size() >= kMostSofts || in_.byte() > 220) {
      if (softs_.empty()) return;
      const SoftId gone = softs_.back();
      softs_.pop_back();
      const std::vector<BodyId> particles = world_.particles(gone);
      world_.destroy(gone);
      for (const BodyId particle : particles) bodyGone(particle);
      return;
    }
    const SoftDef def = softDef();
    const SoftId made = world_.create(def);
    softs_.push_back(made);
    for (const BodyId particle : world_.particles(made)) {
      bodies_.push_back(particle);
      for (const ShapeId shape : world_.shapes(particle)) {
        shapes_.push_back(shape);
        if (!def.contactEvents) silent_.insert(shape);
      }
    }
  });
}

/// Each field mostly in its range, often at its bounds, sometimes beyond.
SoftMaterial Session::softMaterial() {
  SoftMaterial m;
  const auto stiffness = [&] {
    return in_.byte() < 230 ? 1e3f * static_cast<float>(1 << in_.below(16)) : in_.number();
  };
  if (in_.flag()) m.youngsModulus = stiffness();
  constexpr float kPoisson[] = {-0.9f, -0.3f, 0, 0.25f, 0.45f, 0.49f, 0.499f, 0.4999f};
  if (in_.flag()) m.poissonRatio = in_.byte() < 240 ? kPoisson[in_.below(std::size(kPoisson))] : in_.number() / 8;
  if (in_.flag()) m.density = in_.byte() < 240 ? 10 * static_cast<float>(1 + in_.byte()) : in_.number();
  if (in_.flag()) m.thickness = in_.byte() < 240 ? 1e-3f * static_cast<float>(1 + in_.byte()) : in_.number();
  if (in_.flag()) m.bending = in_.number();
  if (in_.flag()) m.damping = in_.byte() < 240 ? in_.positive() / 16 : in_.number();
  if (in_.flag()) m.maxStrain = in_.byte() < 240 ? 1e-3f * static_cast<float>(1 + in_.byte()) : in_.number();
  if (in_.byte() > 150) m.warp = in_.byte() < 240 ? Vec3{1, 0, in_.flag() ? 0.5f : 0.0f} : in_.vector();
  if (m.warp != Vec3{} || in_.byte() > 250) {
    if (in_.flag()) m.weftModulus = stiffness();
    if (in_.flag()) m.shearModulus = stiffness();
  }
  return m;
}

SoftDef Session::softDef() {
  SoftDef def;
  const uint8_t kind = in_.byte();
  const int cells = 1 + static_cast<int>(in_.below(2));
  if (kind < 150)
    def.mesh = makeTetBox({0.3f, 0.2f, 0.4f}, cells, 1, 1);
  else if (kind < 250)
    def.mesh = makeClothGrid(1, 0.7f, 2 * cells, cells);
  def.pose = placePose();
  if (in_.flag()) def.velocity = {in_.vector(), in_.vector()};
  def.material = softMaterial();
  if (kind % 3 == 1) def.material.model = kind < 140 ? SolidModel::Corotational : static_cast<SolidModel>(kind);
  if (in_.flag()) def.radius = in_.byte() < 240 ? 1e-3f * static_cast<float>(1 + in_.byte()) : in_.number();
  def.surface = material();
  def.filter = filter();
  const uint8_t flags = in_.byte();
  def.selfContact = (flags & 3) != 0;
  def.contactEvents = (flags & 12) != 0;
  def.hitEvents = flags & 16;
  def.canSleep = (flags & 96) != 0;
  return def;
}

void Session::makeJoint() {
  attempt([&] {
    const BodyId a = anyBody(), b = anyBody();
    const bool collide = in_.flag();
    if (joints_.size() >= kMostJoints) return;
    // The world's frame is a world pose.
    const auto frame = [&](BodyId body) { return body ? in_.pose() : placePose(); };
    const uint32_t kind = in_.below(16);
    Pose frameA, frameB;
    if (kind < 2 || kind > 3) {
      frameA = frame(a);
      frameB = frame(b);
    }
    if (kind > 3) return makeMovingJoint(kind, a, b, frameA, frameB);
    switch (kind) {
      case 0:
        joints_.push_back(world_.create(BallJoint{a, b, frameA, frameB, collide, 0}));
        return;
      case 1:
        joints_.push_back(world_.create(FixedJoint{a, b, frameA, frameB, collide, 0}));
        return;
      case 2:  // where they are: strains nothing
        if (!a || !b) return;
        joints_.push_back(world_.create(FixedJoint{a, b, {}, inverse(world_.pose(b)) * world_.pose(a), collide, 0}));
        return;
      default:
        joints_.push_back(world_.create(
            TetVolume{{a, b, anyBody(), anyBody()}, in_.flag() ? 0 : in_.number(), in_.flag() ? 0 : in_.number(), 0}));
    }
  });
}

D6Axis Session::axis() {
  D6Axis axis;
  axis.motion = in_.flag() ? AxisMotion::Free : AxisMotion::Locked;
  const uint8_t has = in_.byte();
  if (has & 1) axis.limit.lower = -in_.positive(), axis.limit.upper = in_.positive();
  if (has & 2) axis.drive = {in_.positive() * 100, in_.positive() * 10, in_.number(), in_.number()};
  if (has & 4) axis.friction = in_.positive();
  if (has & 8) axis.spring = {in_.positive() * 100, in_.positive(), in_.number()};
  if (has & 16) axis.armature = in_.positive();
  if (has & 32) axis.limit.stiffness = in_.positive() * 1000, axis.limit.damping = in_.positive();
  if (has & 64) axis.maxVelocity = in_.positive();
  if ((has & 129) == 129) axis.limit.restitution = in_.number(), axis.drive.maxForce = in_.positive();
  return axis;
}

/// Joints with coordinates, and what couples them.
void Session::makeMovingJoint(uint32_t kind, BodyId a, BodyId b, const Pose& frameA, const Pose& frameB) {
  const D6Axis x = axis();
  if (kind < 6) {
    HingeJoint def{a, b, frameA, frameB, x.limit, x.drive, x.friction, x.spring, x.armature, x.maxVelocity};
    joints_.push_back(world_.create(def));
  } else if (kind < 8) {
    SliderJoint def{a, b, frameA, frameB, x.limit, x.drive, x.friction, x.spring, x.armature, x.maxVelocity};
    joints_.push_back(world_.create(def));
  } else if (kind < 11) {
    D6Joint def{a, b, frameA, frameB};
    for (D6Axis& axis : def.axes) axis = this->axis();
    if (in_.byte() > 180) def.cone = {in_.positive(), in_.positive()};
    if (in_.byte() > 180) def.slerp = {in_.positive() * 100, in_.positive(), in_.rotation(), in_.vector()};
    joints_.push_back(world_.create(def));
  } else if (kind < 13) {
    joints_.push_back(world_.create(DistanceJoint{a, b, frameA, frameB, in_.positive(), in_.positive()}));
  } else if (kind < 14) {
    joints_.push_back(
        world_.create(PulleyJoint{a, b, frameA, frameB, place(), place(), in_.positive(), in_.positive()}));
  } else {
    Coupling def;
    const uint32_t terms = 1 + in_.below(3);
    for (uint32_t i = 0; i < terms; ++i) {
      if (joints_.empty()) return;
      def.terms.push_back({joints_[in_.byte() % joints_.size()], static_cast<JointAxis>(in_.below(6)), in_.number()});
    }
    def.axis = x;
    joints_.push_back(world_.create(def));
  }
}

}  // namespace avbd::fuzz
