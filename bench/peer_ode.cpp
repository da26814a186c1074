// ODE as a peer: the same bodies, shapes and joints, its quick step with its own defaults, one step a frame.
#include <ode/ode.h>

#include <cmath>
#include <memory>
#include <unordered_map>

#include "bench/bench.h"

namespace avbd::bench {
namespace {

using scenes::Layout;

[[noreturn]] void refuse(const char* field, const char* range) { throw Error("benchOde", field, "another", range); }

struct OdeLibrary {
  OdeLibrary() { dInitODE2(0); }
  ~OdeLibrary() { dCloseODE(); }
};

class OdeWorld final : public scenes::Engine {
 public:
  OdeWorld(const World& source, const Layout& layout);
  ~OdeWorld() override;
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;
  void step(double dt) override;
  void poses(std::span<Pose> out) const override;

 private:
  /// What a geom belongs to.
  struct Surface {
    size_t body;
    float friction;
    Filter filter;
  };
  void addBody(const World& source, BodyId id);
  void addShape(const World& source, ShapeId shape, size_t body);
  template <class Joint>
  void join(dJointID joint, const Joint& def);
  static void near(void* self, dGeomID a, dGeomID b) { static_cast<OdeWorld*>(self)->touch(a, b); }
  void touch(dGeomID a, dGeomID b);

  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;  ///< by the layout's order; null where nothing moves
  std::vector<Pose> fixed_;      ///< of bodies that do not move
  std::vector<Vec3> centers_;    ///< of mass, in the body's frame: ODE's frames lie there
  std::vector<std::unique_ptr<Surface>> surfaces_;
  std::unordered_map<uint32_t, size_t> slots_;
};

OdeWorld::OdeWorld(const World& source, const Layout& layout) {
  if (!source.softBodies().empty()) throw Error("benchOde", "scene", "soft bodies", "must have none: ODE has none");
  static OdeLibrary library;
  world_ = dWorldCreate();
  space_ = dHashSpaceCreate(nullptr);
  contacts_ = dJointGroupCreate(0);
  const Vec3 g = source.definition().gravity;
  dWorldSetGravity(world_, g.x, g.y, g.z);
  try {
    for (const BodyId id : layout.bodies) addBody(source, id);
    for (const JointId id : source.joints()) {
      if (source.type(id) == JointType::Ball)
        join(dJointCreateBall(world_, nullptr), source.ballJoint(id));
      else if (source.type(id) == JointType::Fixed)
        join(dJointCreateFixed(world_, nullptr), source.fixedJoint(id));
      else
        refuse("joint", "must be a ball or fixed joint");
    }
  } catch (...) {
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    dJointGroupDestroy(contacts_);
    throw;
  }
}

OdeWorld::~OdeWorld() {
  dJointGroupDestroy(contacts_);
  dSpaceDestroy(space_);
  dWorldDestroy(world_);
}

void OdeWorld::addBody(const World& source, BodyId id) {
  const size_t slot = slots_[id.index] = bodies_.size();
  const Pose pose = source.pose(id);
  fixed_.push_back(pose);
  bodies_.push_back(nullptr);
  centers_.push_back({});
  if (source.type(id) == BodyType::Dynamic) {
    const dBodyID body = bodies_[slot] = dBodyCreate(world_);
    centers_[slot] = source.centerOfMass(id);
    const Vec3d at = source.worldCenterOfMass(id);
    const dQuaternion q = {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
    dBodySetPosition(body, at.x, at.y, at.z);
    dBodySetQuaternion(body, q);
    const SymMat3 i = source.inertia(id);
    dMass mass;
    dMassSetParameters(&mass, source.mass(id), 0, 0, 0, i.xx, i.yy, i.zz, i.xy, i.xz, i.yz);
    dBodySetMass(body, &mass);
    const Velocity v = source.velocity(id);
    dBodySetLinearVel(body, v.linear.x, v.linear.y, v.linear.z);
    dBodySetAngularVel(body, v.angular.x, v.angular.y, v.angular.z);
  }
  for (const ShapeId shape : source.shapes(id)) addShape(source, shape, slot);
}

void OdeWorld::addShape(const World& source, ShapeId shape, size_t body) {
  constexpr float kHalf = 0.70710678f;
  const Geometry geometry = source.geometry(shape);
  Pose local = source.localPose(shape);
  dGeomID geom = nullptr;
  if (const auto* s = std::get_if<Sphere>(&geometry)) geom = dCreateSphere(space_, s->radius);
  if (const auto* b = std::get_if<Box>(&geometry); b && b->rounding == 0)
    geom = dCreateBox(space_, 2 * b->x, 2 * b->y, 2 * b->z);
  if (!geom) local.rotation = local.rotation * Quat{kHalf, -kHalf, 0, 0};  // ODE's lie along z
  if (const auto* c = std::get_if<Capsule>(&geometry)) geom = dCreateCapsule(space_, c->radius, 2 * c->halfHeight);
  if (const auto* c = std::get_if<Cylinder>(&geometry); c && c->rounding == 0)
    geom = dCreateCylinder(space_, c->radius, 2 * c->halfHeight);
  if (std::holds_alternative<HalfSpace>(geometry)) {
    const Pose plane = fixed_[body] * source.localPose(shape);
    const Vec3 up = rotate(plane.rotation, Vec3{0, 1, 0});
    geom = dCreatePlane(space_, up.x, up.y, up.z, dot(toDouble(up), plane.position));
  }
  if (!geom) refuse("shape", "must be one of those that ODE has without a mesh");
  surfaces_.push_back(std::make_unique<Surface>(Surface{body, source.material(shape).friction, source.filter(shape)}));
  dGeomSetData(geom, surfaces_.back().get());
  if (std::holds_alternative<HalfSpace>(geometry)) return;
  const bool moves = bodies_[body] != nullptr;
  if (moves) {
    dGeomSetBody(geom, bodies_[body]);
    local.position = local.position - toDouble(centers_[body]);
  } else {
    local = fixed_[body] * local;
  }
  const Vec3d p = local.position;
  const dQuaternion q = {local.rotation.w, local.rotation.x, local.rotation.y, local.rotation.z};
  if (moves) {
    dGeomSetOffsetPosition(geom, p.x, p.y, p.z);
    dGeomSetOffsetQuaternion(geom, q);
  } else {
    dGeomSetPosition(geom, p.x, p.y, p.z);
    dGeomSetQuaternion(geom, q);
  }
}

template <class Joint>
void OdeWorld::join(dJointID joint, const Joint& def) {
  const auto body = [&](BodyId id) -> dBodyID { return id ? bodies_[slots_.at(id.index)] : nullptr; };
  const Pose a = def.bodyA ? fixed_[slots_.at(def.bodyA.index)] * def.frameA : def.frameA;
  dJointAttach(joint, body(def.bodyA), body(def.bodyB));
  if (dJointGetType(joint) == dJointTypeBall)
    dJointSetBallAnchor(joint, a.position.x, a.position.y, a.position.z);
  else
    dJointSetFixed(joint);
}

void OdeWorld::touch(dGeomID a, dGeomID b) {
  constexpr int kMost = 8;
  const auto *sa = static_cast<const Surface*>(dGeomGetData(a)), *sb = static_cast<const Surface*>(dGeomGetData(b));
  const dBodyID first = bodies_[sa->body], second = bodies_[sb->body];
  if (sa->body == sb->body || (!first && !second)) return;
  if (!(sa->filter.category & sb->filter.mask) || !(sb->filter.category & sa->filter.mask)) return;
  if (first && second && dAreConnected(first, second)) return;
  dContact found[kMost];
  const int count = dCollide(a, b, kMost, &found[0].geom, sizeof(dContact));
  for (int i = 0; i < count; ++i) {
    found[i].surface = {};
    found[i].surface.mode = dContactApprox1;
    found[i].surface.mu = std::sqrt(sa->friction * sb->friction);
    dJointAttach(dJointCreateContact(world_, contacts_, &found[i]), first, second);
  }
}

void OdeWorld::step(double dt) {
  dSpaceCollide(space_, this, near);
  dWorldQuickStep(world_, dt);
  dJointGroupEmpty(contacts_);
}

void OdeWorld::poses(std::span<Pose> out) const {
  for (size_t i = 0; i < bodies_.size(); ++i) {
    out[i] = fixed_[i];
    if (!bodies_[i]) continue;
    const dReal *p = dBodyGetPosition(bodies_[i]), *q = dBodyGetQuaternion(bodies_[i]);
    const Quat turn{float(q[0]), float(q[1]), float(q[2]), float(q[3])};
    out[i] = {Vec3d{p[0], p[1], p[2]} - rotate(turn, toDouble(centers_[i])), turn};
  }
}

}  // namespace

BenchRecord benchOde(const scenes::Scene& scene) {
  return observePeer(
      scene, "ode", [](const World& world, const Layout& layout) { return std::make_unique<OdeWorld>(world, layout); });
}

}  // namespace avbd::bench
