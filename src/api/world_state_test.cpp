// What was set is what is read: bodies, mass, impulses, shapes, joints, bulk, life and death.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace avbd {
namespace {

const float kHalf = std::sqrt(0.5f);
const Quat kQuarterZ{kHalf, 0, 0, kHalf};

TEST(World, StartsEmpty) {
  const World world;
  EXPECT_EQ(world.bodyCount() + world.shapeCount() + world.jointCount(), 0u);
  EXPECT_TRUE(world.bodies().empty() && world.joints().empty() && world.contacts().empty());
  EXPECT_EQ(world.time(), 0);
  EXPECT_EQ(world.definition().gravity, (Vec3{0, -9.81f, 0}));
  EXPECT_EQ(world.hash(), World().hash());
}

TEST(World, Settings) {
  World world({.gravity = {1, 2, 3}, .iterations = 7});
  world.setGravity({0, 0, -1});
  world.setIterations(9);
  world.setSubsteps(3);
  EXPECT_EQ(world.definition().gravity, (Vec3{0, 0, -1}));
  EXPECT_EQ(world.definition().iterations, 9);
  EXPECT_EQ(world.definition().substeps, 3);
}

TEST(World, Moves) {
  World first;
  const BodyId id = first.create(BodyDef{.position = {1, 2, 3}, .shape = Box{}});
  World second = std::move(first);
  EXPECT_EQ(second.pose(id).position, (Vec3d{1, 2, 3}));
  first = World();
  EXPECT_EQ(first.bodyCount(), 0u);
  first = std::move(second);
  EXPECT_TRUE(first.isAlive(id));
}

TEST(Bodies, KeepWhatTheyWereGiven) {
  World world;
  const BodyId id = world.create(BodyDef{.position = {1e7 + 0.125, 2, 3},
                                         .rotation = kQuarterZ,
                                         .linearVelocity = {1, 2, 3},
                                         .angularVelocity = {4, 5, 6},
                                         .shape = Box{1, 0.5f, 0.25f},
                                         .density = 100,
                                         .userData = 42});
  EXPECT_EQ(world.type(id), BodyType::Dynamic);
  EXPECT_EQ(world.pose(id), (Pose{{1e7 + 0.125, 2, 3}, kQuarterZ}));
  EXPECT_EQ(world.velocity(id), (Velocity{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_FLOAT_EQ(world.mass(id), 100);
  EXPECT_FLOAT_EQ(world.inertia(id).xx, 100.0f / 3 * (0.25f + 0.0625f));
  EXPECT_EQ(world.userData(id), 42u);
  world.setUserData(id, 43);
  EXPECT_EQ(world.userData(id), 43u);
}

TEST(Bodies, StaticAndKinematicHaveNoMassAndTurnAboutTheirOrigin) {
  World world;
  for (const BodyType type : {BodyType::Static, BodyType::Kinematic}) {
    const BodyId id = world.create(
        BodyDef{.type = type, .position = {1, 0, 0}, .shapes = {{.geometry = Box{}, .pose = {{5, 0, 0}, {}}}}});
    EXPECT_EQ(world.mass(id), 0);
    EXPECT_EQ(world.inertia(id), SymMat3{});
    EXPECT_EQ(world.worldCenterOfMass(id), (Vec3d{1, 0, 0}));
    EXPECT_EQ(world.kineticEnergy(id), 0);
  }
}

TEST(Bodies, CompoundMassAndFrames) {
  World world;
  const ShapeDef left{.geometry = Box{0.5f, 0.5f, 0.5f}, .pose = {{-1, 0, 0}, {}}, .density = 1};
  const ShapeDef right{.geometry = Box{0.5f, 0.5f, 0.5f}, .pose = {{1, 0, 0}, {}}, .density = 3};
  const BodyId id = world.create(BodyDef{.position = {0, 0, 10}, .rotation = kQuarterZ, .shapes = {left, right}});
  EXPECT_FLOAT_EQ(world.mass(id), 4);
  EXPECT_FLOAT_EQ(world.centerOfMass(id).x, 0.5f);
  EXPECT_LT(length(world.worldCenterOfMass(id) - Vec3d{0, 0.5, 10}), 1e-6);
  EXPECT_LT(length(world.pose(id).position - Vec3d{0, 0, 10}), 1e-6);
  // Parallel axes: two cubes of 1/6 m about their own centres, 1.5 and 0.5 from the common one.
  EXPECT_FLOAT_EQ(world.inertia(id).xx, 4.0f / 6);
  EXPECT_FLOAT_EQ(world.inertia(id).yy, 4.0f / 6 + 1 * 1.5f * 1.5f + 3 * 0.5f * 0.5f);
  const std::vector<ShapeId> shapes = world.shapes(id);
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_EQ(world.localPose(shapes[0]).position.x, -1) << "in the order of the definition";
  EXPECT_EQ(world.body(shapes[1]), id);
}

TEST(Bodies, MassFollowsShapesUnlessGiven) {
  World world;
  const BodyId id = world.create(BodyDef{.shape = Box{0.5f, 0.5f, 0.5f}, .density = 2});
  const ShapeId first = world.shapes(id)[0];
  const ShapeId second = world.create(id, {.geometry = Box{0.5f, 0.5f, 0.5f}, .pose = {{3, 0, 0}, {}}, .density = 4});
  EXPECT_FLOAT_EQ(world.mass(id), 6);
  EXPECT_FLOAT_EQ(world.centerOfMass(id).x, 2);
  EXPECT_LT(length(world.pose(id).position), 1e-6) << "the frame stays";
  world.destroy(first);
  EXPECT_FLOAT_EQ(world.mass(id), 4);
  EXPECT_FLOAT_EQ(world.centerOfMass(id).x, 3);
  world.destroy(second);
  EXPECT_FLOAT_EQ(world.mass(id), 4) << "never massless";
  world.create(id, {.geometry = Sphere{}, .density = 0});
  EXPECT_FLOAT_EQ(world.mass(id), 4);
  world.setMassProperties(id, {.mass = 9, .center = {0, 1, 0}});
  world.create(id, {.geometry = Sphere{}});
  EXPECT_EQ(world.mass(id), 9);
  EXPECT_EQ(world.centerOfMass(id), (Vec3{0, 1, 0}));
  const BodyId scaled = world.create(BodyDef{.shape = Box{0.5f, 0.5f, 0.5f}, .mass = 12});
  world.create(scaled, {.geometry = Box{0.5f, 0.5f, 0.5f}, .pose = {{2, 0, 0}, {}}});
  EXPECT_FLOAT_EQ(world.mass(scaled), 12);
  EXPECT_FLOAT_EQ(world.centerOfMass(scaled).x, 1);
}

TEST(Bodies, TeleportIsExactAndRepeatable) {
  World world;
  const BodyId id = world.create(BodyDef{.shapes = {{.geometry = Box{}, .pose = {{0.3, 0.1, 0.7}, {}}}}});
  world.setPose(id, {{1.5, 2.5, -3.5}, kQuarterZ});
  EXPECT_LT(length(world.pose(id).position - Vec3d{1.5, 2.5, -3.5}), 1e-14);
  EXPECT_EQ(world.pose(id).rotation, kQuarterZ);
  const BodyId simple = world.create(BodyDef{.shape = Box{}});
  world.setPose(simple, {{0.1, 0.2, 0.3}, kQuarterZ});
  const uint64_t hash = world.hash();
  world.setPose(simple, world.pose(simple));
  EXPECT_EQ(world.hash(), hash);
  const BodyId ground = world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  world.setPose(ground, {{0, -5, 0}, {}});
  EXPECT_EQ(world.pose(ground).position.y, -5);
}

TEST(Bodies, Impulses) {
  World world;
  const MassProperties mass{.mass = 2, .inertia = {1, 2, 2.5f, 0, 0, 0}};
  const BodyId id = world.create(BodyDef{.position = {0, 1, 0}, .rotation = kQuarterZ, .massProperties = mass});
  world.addImpulse(id, {2, 0, 0});
  EXPECT_EQ(world.velocity(id).linear, (Vec3{1, 0, 0}));
  // The body's x axis, of inertia 1, points along the world's y.
  world.addAngularImpulse(id, {0, 3, 0});
  EXPECT_LT(length(world.velocity(id).angular - Vec3{0, 3, 0}), 1e-6f);
  world.setVelocity(id, {});
  world.addImpulseAt(id, {0, 4, 0}, {0.5, 1, 0});
  EXPECT_LT(length(world.velocity(id).linear - Vec3{0, 2, 0}), 1e-6f);
  EXPECT_LT(length(world.velocity(id).angular - Vec3{0, 0, 2 / 2.5f}), 1e-6f);
  const Vec3d about{3, 1, 4};
  const Vec3d moment = world.angularMomentum(about);
  EXPECT_LT(length(moment - Vec3d{16, 0, -10}), 1e-5) << "(0.5 - 3, 0, -4) x (0, 4, 0)";
  EXPECT_LT(length(world.momentum() - Vec3d{0, 4, 0}), 1e-6);
  EXPECT_NEAR(world.kineticEnergy(), 0.5 * 2 * 4 + 0.5 * 2.5 * 0.64, 1e-5);
  world.setLocks(id, kLockLinearY | kLockAngularZ);
  EXPECT_EQ(world.velocity(id), Velocity{});
  world.addImpulseAt(id, {2, 4, 0}, {0.5, 1, 0});
  EXPECT_EQ(world.velocity(id), (Velocity{{1, 0, 0}, {}}));
}

TEST(Bodies, KinematicVelocityIsTheUsers) {
  World world;
  const BodyId lift = world.create(BodyDef{.type = BodyType::Kinematic, .shape = Box{}});
  world.setVelocity(lift, {{0, 1, 0}, {0, 0, 1}});
  EXPECT_EQ(world.velocity(lift), (Velocity{{0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(world.kineticEnergy(), 0);
}

TEST(Shapes, KeepWhatTheyWereGiven) {
  World world;
  const BodyId id = world.create(BodyDef{.type = BodyType::Static});
  const Geometry geometries[] = {Sphere{1.5f}, Capsule{0.5f, 2}, Box{1, 2, 3}, HalfSpace{}};
  for (const Geometry& geometry : geometries) {
    const ShapeId shape = world.create(id, {.geometry = geometry, .pose = {{1, 2, 3}, kQuarterZ}, .userData = 5});
    EXPECT_EQ(world.geometry(shape).index(), geometry.index());
    EXPECT_EQ(world.localPose(shape), (Pose{{1, 2, 3}, kQuarterZ}));
    EXPECT_EQ(world.userData(shape), 5u);
  }
  EXPECT_EQ(std::get<Capsule>(world.geometry(world.shapes(id)[1])).halfHeight, 2);
  const ShapeId shape = world.shapes(id)[2];
  world.setMaterial(shape, {.friction = 0.25f, .staticFriction = 0.5f, .restitution = 1});
  EXPECT_EQ(world.material(shape).staticFriction, 0.5f);
  world.setFilter(shape, {.category = 2, .mask = 4, .group = -1});
  EXPECT_EQ(world.filter(shape).group, -1);
}

TEST(Joints, GiveTheirDefinitionsBack) {
  World world;
  const BodyId a = world.create(BodyDef{.shape = Box{}}), b = world.create(BodyDef{.shape = Box{}});
  const Pose frameA{{1, 0, 0}, kQuarterZ}, frameB{{0, 2, 0}, {}};
  const JointId ball = world.create(BallJoint{a, b, frameA, frameB, true, 8});
  const BallJoint gotBall = world.ballJoint(ball);
  EXPECT_EQ(gotBall.bodyA, a);
  EXPECT_EQ(gotBall.bodyB, b);
  EXPECT_EQ(gotBall.frameA, frameA);
  EXPECT_TRUE(gotBall.collideConnected);
  EXPECT_EQ(gotBall.userData, 8u);
  const JointId fixed = world.create(FixedJoint{{}, b, {}, frameB});
  EXPECT_EQ(world.fixedJoint(fixed).bodyA, BodyId{});
  EXPECT_EQ(world.fixedJoint(fixed).frameB, frameB);
  EXPECT_EQ(world.type(fixed), JointType::Fixed);
  EXPECT_NEAR(world.gap(fixed), 2, 1e-9);
  EXPECT_EQ(world.angleError(fixed), 0);
  const BodyId c = world.create(BodyDef{.position = {0, 3, 0}, .shape = Box{}});
  const BodyId d = world.create(BodyDef{.position = {0, 0, 3}, .shape = Box{}});
  world.setPose(b, {{3, 0, 0}, {}});
  const JointId tet = world.create(TetVolume{.bodies = {a, b, c, d}, .stiffness = 2});
  EXPECT_FLOAT_EQ(world.tetVolume(tet).restVolume, 27.0f / 6);
  EXPECT_EQ(world.tetVolume(tet).bodies[3], d);
  EXPECT_EQ(world.tetVolume(tet).stiffness, 2);
  EXPECT_NEAR(world.gap(tet), 0, 1e-6);
}

TEST(Joints, FollowTheCentreOfMass) {
  World world;
  const BodyId a = world.create(BodyDef{.shape = Box{}});
  const JointId joint = world.create(BallJoint{.bodyA = a, .frameA = {{1, 0, 0}, {}}, .frameB = {{1, 0, 0}, {}}});
  EXPECT_NEAR(world.gap(joint), 0, 1e-9);
  world.setMassProperties(a, {.center = {0.3f, 0.4f, 0}});
  EXPECT_NEAR(world.gap(joint), 0, 1e-6);
  world.create(a, {.geometry = Sphere{}, .pose = {{0, 5, 0}, {}}});
  EXPECT_NEAR(world.gap(joint), 0, 1e-6);
  world.setPose(a, {{0, 0, 2}, {}});
  EXPECT_NEAR(world.gap(joint), 2, 1e-6);
}

TEST(Joints, DieWithTheirBodies) {
  World world;
  const BodyId a = world.create(BodyDef{.shape = Box{}}), b = world.create(BodyDef{.shape = Box{}});
  const JointId first = world.create(BallJoint{.bodyA = a, .bodyB = b});
  const JointId second = world.create(BallJoint{.bodyB = b});
  world.destroy(a);
  EXPECT_FALSE(world.isAlive(first));
  EXPECT_TRUE(world.isAlive(second));
  EXPECT_EQ(world.joints(), std::vector<JointId>{second});
}

TEST(Bulk, EqualsOneByOne) {
  World one, many;
  std::vector<BodyId> ids;
  std::vector<Velocity> velocities;
  std::vector<Vec3> forces;
  for (int i = 0; i < 20; ++i) {
    const BodyDef def{.position = {double(i) * 3, 0, 0}, .shape = Box{}};
    one.create(def);
    ids.push_back(many.create(def));
    velocities.push_back({{float(i), 0, 1}, {0, float(-i), 0}});
    forces.push_back({0, float(i * i), 0});
  }
  many.setVelocities(ids, velocities);
  many.addForces(ids, forces);
  many.addForces(ids, forces);
  for (size_t i = 0; i < ids.size(); ++i) {
    one.setVelocity(ids[i], velocities[i]);
    one.addForce(ids[i], forces[i]);
    one.addForce(ids[i], forces[i]);
  }
  EXPECT_EQ(one.hash(), many.hash());
  std::vector<Velocity> got(ids.size());
  std::vector<Pose> poses(ids.size());
  many.getVelocities(ids, got);
  many.getPoses(ids, poses);
  EXPECT_EQ(got, velocities);
  for (size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(poses[i], one.pose(ids[i]));
  many.getPoses({}, {});
}

// Creates and destroys at random beside a model that is nothing but maps.
class Churn {
 public:
  void run(int count) {
    for (int i = 0; i < count; ++i) {
      act();
      if (i % 50 == 0) compare();
      if (testing::Test::HasFatalFailure()) return;
    }
    compare();
  }

 private:
  struct Shape {
    BodyId body;
    uint64_t userData;
  };
  struct Joint {
    BodyId a, b;
  };

  template <class Id, class Value>
  Id pick(const std::map<Id, Value>& from) {
    return std::next(from.begin(), static_cast<std::ptrdiff_t>(random_() % from.size()))->first;
  }

  void act() {
    const uint32_t choice = random_() % 10;
    if (bodies_.size() < 5 || (choice < 3 && bodies_.size() < 100)) {
      makeBody();
    } else if (choice < 5) {
      destroyBody(pick(bodies_));
    } else if (choice == 5) {
      const BodyId body = pick(bodies_);
      shapes_[world_.create(body, {.geometry = Sphere{}, .userData = next_})] = {body, next_};
      ++next_;
    } else if (choice == 6 && !shapes_.empty()) {
      const ShapeId shape = pick(shapes_);
      world_.destroy(shape);
      shapes_.erase(shape);
      deadShapes_.push_back(shape);
    } else if (choice < 9) {
      const BodyId a = pick(bodies_), b = pick(bodies_);
      if (a != b) joints_[world_.create(BallJoint{.bodyA = a, .bodyB = b})] = {a, b};
    } else if (!joints_.empty()) {
      const JointId joint = pick(joints_);
      world_.destroy(joint);
      joints_.erase(joint);
      deadJoints_.push_back(joint);
    }
  }

  void makeBody() {
    BodyDef def{.position = {double(random_() % 100), 0, 0}, .shapes = {{}, {}}, .userData = next_++};
    for (ShapeDef& shape : def.shapes) shape.userData = next_++;
    const BodyId body = world_.create(def);
    ASSERT_TRUE(bodies_.insert({body, def.userData}).second);
    for (const ShapeId shape : world_.shapes(body)) shapes_[shape] = {body, world_.userData(shape)};
  }

  void destroyBody(BodyId body) {
    world_.destroy(body);
    bodies_.erase(body);
    deadBodies_.push_back(body);
    std::erase_if(shapes_, [&](const auto& entry) {
      if (entry.second.body == body) deadShapes_.push_back(entry.first);
      return entry.second.body == body;
    });
    std::erase_if(joints_, [&](const auto& entry) {
      const bool touches = entry.second.a == body || entry.second.b == body;
      if (touches) deadJoints_.push_back(entry.first);
      return touches;
    });
  }

  void compare() const {
    ASSERT_EQ(world_.bodyCount(), bodies_.size());
    ASSERT_EQ(world_.shapeCount(), shapes_.size());
    ASSERT_EQ(world_.jointCount(), joints_.size());
    for (const auto& [id, userData] : bodies_) ASSERT_EQ(world_.userData(id), userData);
    for (const auto& [id, shape] : shapes_) {
      ASSERT_EQ(world_.body(id), shape.body);
      ASSERT_EQ(world_.userData(id), shape.userData);
    }
    for (const auto& [id, joint] : joints_) {
      ASSERT_EQ(world_.ballJoint(id).bodyA, joint.a);
      ASSERT_EQ(world_.ballJoint(id).bodyB, joint.b);
    }
    for (const BodyId id : deadBodies_) ASSERT_FALSE(world_.isAlive(id));
    for (const ShapeId id : deadShapes_) ASSERT_FALSE(world_.isAlive(id));
    for (const JointId id : deadJoints_) ASSERT_FALSE(world_.isAlive(id));
  }

  World world_;
  std::mt19937 random_{11};
  uint64_t next_ = 1;
  std::map<BodyId, uint64_t> bodies_;
  std::map<ShapeId, Shape> shapes_;
  std::map<JointId, Joint> joints_;
  std::vector<BodyId> deadBodies_;
  std::vector<ShapeId> deadShapes_;
  std::vector<JointId> deadJoints_;
};

TEST(World, ChurnAgreesWithMaps) { Churn().run(10000); }

}  // namespace
}  // namespace avbd
