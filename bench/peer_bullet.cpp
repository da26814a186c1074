// Bullet as a peer: the same bodies, shapes and joints, its own defaults, one step a frame or four.
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>

#include "bench/bench.h"
#include "bench/peer_bullet_soft.h"

namespace avbd::bench {
namespace {

using scenes::Layout;

btVector3 toBullet(Vec3d v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }
btVector3 toBullet(Vec3 v) { return {v.x, v.y, v.z}; }
btTransform toBullet(const Pose& p) {
  const Quat q = p.rotation;
  return btTransform(btQuaternion(q.x, q.y, q.z, q.w), toBullet(p.position));
}
Pose fromBullet(const btTransform& t) {
  const btQuaternion q = t.getRotation();
  const btVector3 p = t.getOrigin();
  return {{p.x(), p.y(), p.z()}, {float(q.w()), float(q.x()), float(q.y()), float(q.z())}};
}

/// Keeps the heights that Bullet's shape only points to. Bullet centres the field between its lowest and highest point:
/// with the range -h .. h that is where ours is.
class HeightFieldShape final : public btHeightfieldTerrainShape {
 public:
  explicit HeightFieldShape(const HeightFieldData& data) : HeightFieldShape(data, heightsOf(data)) {}

 private:
  static std::vector<float> heightsOf(const HeightFieldData& data) {
    std::vector<float> heights;
    for (int r = 0; r < data.rows(); ++r)
      for (int c = 0; c < data.columns(); ++c) heights.push_back(data.height(c, r));
    return heights;
  }
  HeightFieldShape(const HeightFieldData& data, std::vector<float> heights)
      : btHeightfieldTerrainShape(data.columns(), data.rows(), heights.data(), 1, -highest(data), highest(data), 1,
                                  PHY_FLOAT, false),
        heights_(std::move(heights)) {
    setLocalScaling({data.spacingX(), 1, data.spacingZ()});
  }
  static btScalar highest(const HeightFieldData& data) { return std::max(data.upper().y, -data.lower().y); }
  std::vector<float> heights_;  // moving keeps their address
};

[[noreturn]] void refuse(const char* field, const char* value, const char* range) {
  throw Error("benchBullet", field, value, range);
}

class BulletWorld final : public scenes::Engine {
 public:
  BulletWorld(const World& source, const Layout& layout, int substeps);
  ~BulletWorld() override;
  void step(double dt) override;
  void poses(std::span<Pose> out) const override;

 private:
  void build(const World& source, const Layout& layout);
  void clear();
  void addBody(const World& source, BodyId id, size_t place);
  btCollisionShape* shapeOf(const World& source, BodyId id, const btTransform& massFrame, btTransform& shift);
  btCollisionShape* keep(std::unique_ptr<btCollisionShape> shape);
  template <class Joint>
  void frames(const Joint& def, btRigidBody*& a, btRigidBody*& b, btTransform& inA, btTransform& inB);
  void addBall(const BallJoint& def);
  void addFixed(const FixedJoint& def);
  void addConstraint(std::unique_ptr<btTypedConstraint> constraint, bool collide);

  int substeps_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> rigid_;  ///< of a scene without soft bodies
  std::unique_ptr<BulletSofts> softs_;              ///< of one with some
  btDiscreteDynamicsWorld* world_ = nullptr;        ///< of either
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<btTransform> massFrames_;  ///< of each body: its mass frame in its own frame
  std::vector<size_t> places_;           ///< of each body: which of the layout's it is
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::unordered_map<uint32_t, size_t> slots_;
};

BulletWorld::BulletWorld(const World& source, const Layout& layout, int substeps) : substeps_(substeps) {
  if (source.softBodies().empty()) {
    rigid_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, &solver_, &configuration_);
    world_ = rigid_.get();
  } else {
    softs_ = std::make_unique<BulletSofts>(&dispatcher_, &broadphase_, &configuration_);
    world_ = &softs_->world();
  }
  try {
    build(source, layout);
  } catch (...) {
    clear();
    throw;
  }
}

void BulletWorld::build(const World& source, const Layout& layout) {
  world_->setGravity(toBullet(source.definition().gravity));
  for (size_t i = 0; i < layout.bodies.size(); ++i)
    if (!source.softBody(layout.bodies[i])) addBody(source, layout.bodies[i], i);
  if (softs_) softs_->add(source, layout);
  for (const JointId id : source.joints()) switch (source.type(id)) {
      case JointType::Ball:
        addBall(source.ballJoint(id));
        break;
      case JointType::Fixed:
        addFixed(source.fixedJoint(id));
        break;
      default:
        refuse("joint", "another", "must be a ball or fixed joint");
    }
}

BulletWorld::~BulletWorld() { clear(); }

// The worlds look at what is in them as they end.
void BulletWorld::clear() {
  for (const auto& c : constraints_) world_->removeConstraint(c.get());
  for (const auto& b : bodies_) world_->removeRigidBody(b.get());
}

void BulletWorld::step(double dt) {
  for (int i = 0; i < substeps_; ++i) {
    world_->stepSimulation(btScalar(dt / substeps_), 0);
  }
  if (softs_) softs_->checkFinite();
}

void BulletWorld::poses(std::span<Pose> out) const {
  for (size_t i = 0; i < bodies_.size(); ++i)
    out[places_[i]] = fromBullet(bodies_[i]->getCenterOfMassTransform() * massFrames_[i].inverse());
  if (softs_) softs_->poses(out);
}

btCollisionShape* BulletWorld::keep(std::unique_ptr<btCollisionShape> shape) {
  shapes_.push_back(std::move(shape));
  return shapes_.back().get();
}

std::unique_ptr<btCollisionShape> makeShape(const Geometry& geometry) {
  if (const auto* s = std::get_if<Sphere>(&geometry)) return std::make_unique<btSphereShape>(s->radius);
  if (const auto* c = std::get_if<Capsule>(&geometry))
    return std::make_unique<btCapsuleShape>(c->radius, 2 * c->halfHeight);
  if (const auto* b = std::get_if<Box>(&geometry)) return std::make_unique<btBoxShape>(btVector3(b->x, b->y, b->z));
  if (const auto* c = std::get_if<Cylinder>(&geometry))
    return std::make_unique<btCylinderShape>(btVector3(c->radius, c->halfHeight, c->radius));
  if (const auto* h = std::get_if<Hull>(&geometry)) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3 v : h->data->vertices()) hull->addPoint({v.x * h->scale.x, v.y * h->scale.y, v.z * h->scale.z});
    return hull;
  }
  if (const auto* f = std::get_if<HeightField>(&geometry)) return std::make_unique<HeightFieldShape>(*f->data);
  if (!std::holds_alternative<HalfSpace>(geometry)) refuse("shape", "another", "must be one of those that Bullet has");
  return std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
}

bool isIdentity(const btTransform& t) {
  return t.getOrigin().length2() == 0 && t.getBasis() == btMatrix3x3::getIdentity();
}

// The shapes in the mass frame. `shift` moves the whole body where one shape alone (a plane) cannot be moved inside it.
btCollisionShape* BulletWorld::shapeOf(const World& source, BodyId id, const btTransform& massFrame,
                                       btTransform& shift) {
  shift.setIdentity();
  const std::vector<ShapeId> ids = source.shapes(id);
  if (ids.empty()) return keep(std::make_unique<btEmptyShape>());
  if (ids.size() == 1) {
    const btTransform local = massFrame.inverse() * toBullet(source.localPose(ids[0]));
    const bool plane = std::holds_alternative<HalfSpace>(source.geometry(ids[0]));
    if (plane) shift = local;
    if (plane || isIdentity(local)) return keep(makeShape(source.geometry(ids[0])));
  }
  auto compound = std::make_unique<btCompoundShape>();
  for (const ShapeId s : ids) {
    if (std::holds_alternative<HalfSpace>(source.geometry(s)))
      refuse("shape", "HalfSpace", "must be the only shape of its body");
    compound->addChildShape(massFrame.inverse() * toBullet(source.localPose(s)), keep(makeShape(source.geometry(s))));
  }
  return keep(std::move(compound));
}

// Bullet wants a diagonal inertia: its body frame is the mass frame.
btTransform principalFrame(const World& source, BodyId id, btVector3& inertia) {
  const SymMat3 i = source.inertia(id);
  btMatrix3x3 m(i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz), turn = btMatrix3x3::getIdentity();
  if (i.xy != 0 || i.xz != 0 || i.yz != 0) m.diagonalize(turn, btScalar(1e-6), 50);
  inertia = {m[0][0], m[1][1], m[2][2]};
  return btTransform(turn, toBullet(source.centerOfMass(id)));
}

void BulletWorld::addBody(const World& source, BodyId id, size_t place) {
  const bool dynamic = source.type(id) == BodyType::Dynamic;
  btVector3 inertia(0, 0, 0);
  btTransform massFrame = btTransform::getIdentity(), shift;
  if (dynamic) massFrame = principalFrame(source, id, inertia);
  btCollisionShape* shape = shapeOf(source, id, massFrame, shift);
  massFrame = massFrame * shift;
  btRigidBody::btRigidBodyConstructionInfo info(dynamic ? source.mass(id) : 0, nullptr, shape, inertia);
  info.m_startWorldTransform = toBullet(source.pose(id)) * massFrame;
  Filter filter;
  const std::vector<ShapeId> ids = source.shapes(id);
  if (!ids.empty()) {
    const Material material = source.material(ids[0]);
    // Bullet multiplies friction and restitution; the root makes the pair's friction the geometric mean.
    info.m_friction = std::sqrt(material.friction);
    info.m_restitution = material.restitution;
    filter = source.filter(ids[0]);
  }
  auto body = std::make_unique<btRigidBody>(info);
  if (dynamic) {
    const Velocity v = source.velocity(id);
    body->setLinearVelocity(toBullet(v.linear));
    body->setAngularVelocity(toBullet(v.angular));
    body->setActivationState(DISABLE_DEACTIVATION);
  }
  world_->addRigidBody(body.get(), static_cast<int>(filter.category), static_cast<int>(filter.mask));
  slots_[id.index] = bodies_.size();
  bodies_.push_back(std::move(body));
  massFrames_.push_back(massFrame);
  places_.push_back(place);
}

template <class Joint>
void BulletWorld::frames(const Joint& def, btRigidBody*& a, btRigidBody*& b, btTransform& inA, btTransform& inB) {
  const auto side = [&](BodyId id, const Pose& frame, btRigidBody*& body, btTransform& in) {
    if (id && !slots_.count(id.index)) refuse("joint", "of a particle", "must be of two bodies that are none");
    const size_t slot = id ? slots_.at(id.index) : 0;
    body = id ? bodies_[slot].get() : &btTypedConstraint::getFixedBody();
    in = id ? massFrames_[slot].inverse() * toBullet(frame) : toBullet(frame);
  };
  side(def.bodyA, def.frameA, a, inA);
  side(def.bodyB, def.frameB, b, inB);
}

void BulletWorld::addBall(const BallJoint& def) {
  btRigidBody *a, *b;
  btTransform inA, inB;
  frames(def, a, b, inA, inB);
  addConstraint(std::make_unique<btPoint2PointConstraint>(*a, *b, inA.getOrigin(), inB.getOrigin()),
                def.collideConnected);
}

void BulletWorld::addFixed(const FixedJoint& def) {
  btRigidBody *a, *b;
  btTransform inA, inB;
  frames(def, a, b, inA, inB);
  addConstraint(std::make_unique<btFixedConstraint>(*a, *b, inA, inB), def.collideConnected);
}

void BulletWorld::addConstraint(std::unique_ptr<btTypedConstraint> constraint, bool collide) {
  world_->addConstraint(constraint.get(), !collide);
  constraints_.push_back(std::move(constraint));
}

BenchRecord observeBullet(const scenes::Scene& scene, const char* name, int substeps) {
  return observePeer(scene, name, [substeps](const World& world, const Layout& layout) {
    return std::make_unique<BulletWorld>(world, layout, substeps);
  });
}

}  // namespace

BenchRecord benchBullet(const scenes::Scene& scene) { return observeBullet(scene, "bullet", 1); }
BenchRecord benchBullet4(const scenes::Scene& scene) { return observeBullet(scene, "bullet4", 4); }

}  // namespace avbd::bench
