// The world as users see it: refusals change nothing, ids die, what was set is what is read.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace avbd {
namespace {

const float kNan = std::nanf(""), kInf = std::numeric_limits<float>::infinity();

// Everything that can be read, as one text: equal texts mean that nothing has changed.
std::string everything(const World& world) {
  std::string text = std::to_string(world.hash()) + " " + std::to_string(world.shapeCount());
  const auto add = [&](auto... values) { ((text.append(" ").append(std::to_string(values))), ...); };
  const WorldDef& def = world.definition();
  add(def.gravity.x, def.gravity.y, def.gravity.z, def.iterations, def.substeps, world.time());
  for (const BodyId id : world.bodies()) {
    const SymMat3 i = world.inertia(id);
    const Vec3 center = world.centerOfMass(id);
    add(id.index, id.generation, world.mass(id), i.xx, i.yy, i.zz, i.xy, center.x, center.y, world.userData(id));
    add(world.pose(id).position.x, world.pose(id).rotation.w);
    for (const ShapeId shape : world.shapes(id)) {
      const Material m = world.material(shape);
      add(shape.index, m.friction, m.restitution, world.localPose(shape).position.y, world.userData(shape));
      add(world.filter(shape).category, world.filter(shape).mask, world.filter(shape).group);
    }
  }
  for (const JointId id : world.joints()) add(id.index, id.generation, world.gap(id), world.userData(id));
  return text;
}

class Refusal : public testing::Test {
 protected:
  void refuse(const std::function<void()>& call, const std::string& definition, const std::string& field,
              const std::string& value, const std::string& range) {
    const std::string before = everything(world);
    try {
      call();
      ADD_FAILURE() << definition << "." << field << " = " << value << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.definition(), definition);
      EXPECT_EQ(error.field(), field);
      EXPECT_EQ(error.value(), value);
      EXPECT_NE(error.range().find(range), std::string::npos) << definition << "." << field << ": " << error.range();
    }
    EXPECT_EQ(everything(world), before) << definition << "." << field << " changed something";
  }

  World world;
  BodyId box = world.create(BodyDef{.position = {0, 3, 0}, .shape = Box{}, .userData = 7});
  BodyId ball = world.create(BodyDef{.position = {3, 3, 0}, .linearVelocity = {1, 0, 0}, .shape = Sphere{}});
  BodyId ground = world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  BodyId lift = world.create(BodyDef{.type = BodyType::Kinematic, .position = {9, 0, 0}, .shape = Box{}});
  ShapeId shape = world.shapes(box)[0];
  JointId joint = world.create(BallJoint{.bodyA = box, .frameB = {{0, 4, 0}, {}}});
};

TEST_F(Refusal, Definitions) {
  refuse([&] { world.create(BodyDef{.shape = Sphere{-1}}); }, "BodyDef", "shape.radius", "-1", ">= 1e-06");
  refuse([&] { world.create(BodyDef{}); }, "BodyDef", "massProperties", "nothing", "must be given");
  refuse([&] { world.create(box, ShapeDef{.density = kNan}); }, "ShapeDef", "density", "nan", ">= 0");
  refuse([&] { world.create(box, ShapeDef{.geometry = HalfSpace{}}); }, "ShapeDef", "geometry", "HalfSpace", "bounded");
  refuse(
      [&] {
        world.create(box, ShapeDef{.geometry = Box{1e6f, 1e6f, 1e6f}});
      },
      "ShapeDef", "density", "8e+21", "must give a mass");
  refuse([&] { world.create(BodyId{}, ShapeDef{}); }, "World::create", "body", "null", "must name a living body");
  refuse([&] { world.create(BallJoint{}); }, "BallJoint", "bodyB", "null", "must differ");
  refuse([&] { world.create(FixedJoint{.bodyA = ground}); }, "FixedJoint", "bodyB", "null", "must be dynamic");
  refuse([&] { world.create(TetVolume{}); }, "TetVolume", "bodies[0]", "null", "must name a living body");
  EXPECT_THROW(World({.workers = 0}), Error);
}

TEST_F(Refusal, Settings) {
  refuse([&] { world.setGravity({0, kNan, 0}); }, "World::setGravity", "gravity", "(0, nan, 0)", "must be finite");
  refuse([&] { world.setIterations(0); }, "World::setIterations", "iterations", "0", "1 .. 1000");
  refuse([&] { world.setSubsteps(1001); }, "World::setSubsteps", "substeps", "1001", "1 .. 1000");
  for (const float dt : {kNan, 0.0f, -1.0f, 1.5f, kInf}) EXPECT_THROW(world.step(dt), Error) << dt;
  refuse([&] { world.step(-0.5f); }, "World::step", "dt", "-0.5", "must be finite and > 0 and at most 1");
  EXPECT_THROW(world.angularMomentum({std::nan(""), 0, 0}), Error);
}

TEST_F(Refusal, BodyState) {
  const Pose bad{{0, 0, kNan}, {}}, turned{{}, {0.5f, 0, 0, 0}};
  refuse([&] { world.setPose(box, bad); }, "World::setPose", "pose.position", "(0, 0, nan)", "must be finite");
  refuse([&] { world.setPose(box, turned); }, "World::setPose", "pose.rotation", "(0.5, 0, 0, 0)", "within 0.001");
  refuse(
      [&] {
        world.setVelocity(box, {{kInf, 0, 0}, {}});
      },
      "World::setVelocity", "velocity.linear", "(inf, 0, 0)", "must be finite");
  refuse(
      [&] {
        world.setVelocity(box, {{}, {0, kNan, 0}});
      },
      "World::setVelocity", "velocity.angular", "(0, nan, 0)", "must be finite");
  refuse([&] { world.setVelocity(ground, {}); }, "World::setVelocity", "id", "3 (generation 1)", "not name a static");
  refuse([&] { world.setDamping(box, -1, 0); }, "World::setDamping", "linear", "-1", ">= 0");
  refuse([&] { world.setDamping(box, 1, kNan); }, "World::setDamping", "angular", "nan", ">= 0");
  refuse([&] { world.setGravityScale(box, kNan); }, "World::setGravityScale", "scale", "nan", "must be finite");
  refuse([&] { world.setLocks(box, 200); }, "World::setLocks", "locks", "200", "0 .. 63");
  refuse([&] { world.setMaxSpeeds(box, 0, 1); }, "World::setMaxSpeeds", "linear", "0", "> 0");
  refuse([&] { world.setMaxSpeeds(box, 1, kInf); }, "World::setMaxSpeeds", "angular", "inf", "> 0");
  refuse([&] { world.setMassProperties(box, {.mass = 0}); }, "World::setMassProperties", "properties.mass", "0",
         ">= 1e-24");
  refuse([&] { world.setMassProperties(lift, {}); }, "World::setMassProperties", "id", "4 (generation 1)", "dynamic");
  refuse([&] { world.excludeCollision(box, box); }, "World::excludeCollision", "b", "1 (generation 1)", "must differ");
  refuse([&] { world.allowCollision(box, {}); }, "World::allowCollision", "b", "null", "must name a living body");
  refuse([&] { world.allowCollision(box, box); }, "World::allowCollision", "b", "1 (generation 1)", "must differ");
  refuse([&] { world.setMaterial(shape, {.friction = -1}); }, "World::setMaterial", "material.friction", "-1", ">= 0");
}

TEST_F(Refusal, Forces) {
  refuse([&] { world.addForce(box, {kNan, 0, 0}); }, "World::addForce", "force", "(nan, 0, 0)", "must be finite");
  refuse([&] { world.addForce(ground, {}); }, "World::addForce", "id", "3 (generation 1)", "must name a dynamic body");
  refuse(
      [&] {
        world.addForceAt(box, {}, {0, std::nan(""), 0});
      },
      "World::addForceAt", "point", "(0, nan, 0)", "must be finite");
  refuse([&] { world.addForceAt(box, {kInf, 0, 0}, {}); }, "World::addForceAt", "force", "(inf, 0, 0)", "finite");
  refuse([&] { world.addTorque(box, {1e19f, 0, 0}); }, "World::addTorque", "torque", "(1e+19, 0, 0)", "between");
  refuse([&] { world.addImpulse(box, {0, kInf, 0}); }, "World::addImpulse", "impulse", "(0, inf, 0)", "finite");
  refuse(
      [&] {
        world.addImpulse(box, {0, 1e17f, 0});
      },
      "World::addImpulse", "impulse", "(0, 1e+17, 0)", "must not take the body's velocity beyond 1e+09");
  refuse(
      [&] {
        world.addImpulseAt(box, {0, 1e5f, 0}, {1e6, 0, 0});
      },
      "World::addImpulseAt", "impulse", "(0, 1e+05, 0)", "must not take the body's velocity beyond 1e+06");
  refuse(
      [&] {
        world.addImpulseAt(box, {}, {std::nan(""), 0, 0});
      },
      "World::addImpulseAt", "point", "(nan, 0, 0)", "must be finite");
  refuse(
      [&] {
        world.addAngularImpulse(box, {1e15f, 0, 0});
      },
      "World::addAngularImpulse", "impulse", "(1e+15, 0, 0)", "must not take");
  refuse([&] { world.addAngularImpulse(lift, {}); }, "World::addAngularImpulse", "id", "4 (generation 1)", "dynamic");
}

TEST_F(Refusal, Bulk) {
  const std::vector<BodyId> ids = {box, ball}, withGround = {box, ground}, withNull = {box, {}};
  std::vector<Pose> poses(3);
  refuse([&] { world.getPoses(ids, poses); }, "World::getPoses", "out", "3 values", "must be as many as ids: 2");
  std::vector<Velocity> velocities(2, Velocity{{5, 0, 0}, {}});
  refuse([&] { world.getVelocities(withNull, velocities); }, "World::getVelocities", "ids[1]", "null", "living body");
  EXPECT_EQ(velocities[0].linear.x, 5) << "nothing was written";
  refuse([&] { world.setVelocities(withGround, velocities); }, "World::setVelocities", "ids[1]", "3 (generation 1)",
         "not name a static");
  velocities[1].angular.y = kNan;
  refuse([&] { world.setVelocities(ids, velocities); }, "World::setVelocities", "in[1].angular", "(0, nan, 0)",
         "must be finite");
  const std::vector<Vec3> forces = {{1, 0, 0}, {kNan, 0, 0}};
  refuse([&] { world.addForces(ids, forces); }, "World::addForces", "forces[1]", "(nan, 0, 0)", "must be finite");
  refuse([&] { world.addForces(withGround, forces); }, "World::addForces", "ids[1]", "3 (generation 1)", "dynamic");
  refuse([&] { world.addForces(ids, {}); }, "World::addForces", "forces", "0 values", "must be as many as ids: 2");
}

// Calls every function that takes the id.
void useEverywhere(World& world, BodyId id, const std::function<void(const char*, const std::function<void()>&)>& use) {
  use("create", [&] { world.create(id, ShapeDef{}); });
  use("destroy", [&] { world.destroy(id); });
  use("type", [&] { world.type(id); });
  use("pose", [&] { world.pose(id); });
  use("setPose", [&] { world.setPose(id, {}); });
  use("velocity", [&] { world.velocity(id); });
  use("setVelocity", [&] { world.setVelocity(id, {}); });
  use("mass", [&] { world.mass(id); });
  use("inertia", [&] { world.inertia(id); });
  use("centerOfMass", [&] { world.centerOfMass(id); });
  use("worldCenterOfMass", [&] { world.worldCenterOfMass(id); });
  use("setMassProperties", [&] { world.setMassProperties(id, {}); });
  use("addForce", [&] { world.addForce(id, {}); });
  use("addForceAt", [&] { world.addForceAt(id, {}, {}); });
  use("addTorque", [&] { world.addTorque(id, {}); });
  use("addImpulse", [&] { world.addImpulse(id, {}); });
  use("addImpulseAt", [&] { world.addImpulseAt(id, {}, {}); });
  use("addAngularImpulse", [&] { world.addAngularImpulse(id, {}); });
  use("setDamping", [&] { world.setDamping(id, 0, 0); });
  use("setGravityScale", [&] { world.setGravityScale(id, 1); });
  use("setLocks", [&] { world.setLocks(id, 0); });
  use("setMaxSpeeds", [&] { world.setMaxSpeeds(id, 1, 1); });
  use("userData", [&] { world.userData(id); });
  use("setUserData", [&] { world.setUserData(id, 1); });
  use("shapes", [&] { world.shapes(id); });
  use("kineticEnergy", [&] { world.kineticEnergy(id); });
}

void useEverywhere(World& world, ShapeId id,
                   const std::function<void(const char*, const std::function<void()>&)>& use) {
  use("destroy", [&] { world.destroy(id); });
  use("body", [&] { world.body(id); });
  use("geometry", [&] { world.geometry(id); });
  use("localPose", [&] { world.localPose(id); });
  use("material", [&] { world.material(id); });
  use("setMaterial", [&] { world.setMaterial(id, {}); });
  use("filter", [&] { world.filter(id); });
  use("setFilter", [&] { world.setFilter(id, {}); });
  use("userData", [&] { world.userData(id); });
  use("setUserData", [&] { world.setUserData(id, 1); });
}

void useEverywhere(World& world, JointId id,
                   const std::function<void(const char*, const std::function<void()>&)>& use) {
  use("destroy", [&] { world.destroy(id); });
  use("type", [&] { world.type(id); });
  use("ballJoint", [&] { world.ballJoint(id); });
  use("fixedJoint", [&] { world.fixedJoint(id); });
  use("tetVolume", [&] { world.tetVolume(id); });
  use("reaction", [&] { world.reaction(id); });
  use("gap", [&] { world.gap(id); });
  use("angleError", [&] { world.angleError(id); });
  use("userData", [&] { world.userData(id); });
  use("setUserData", [&] { world.setUserData(id, 1); });
}

TEST_F(Refusal, DeadNullAndForeignIdsEverywhere) {
  World larger;
  BodyId foreignBody;
  for (int i = 0; i < 50; ++i) foreignBody = larger.create(BodyDef{.shape = Box{}});
  const ShapeId foreignShape = larger.shapes(foreignBody)[0];
  const BodyId deadBody = world.create(BodyDef{.shape = Box{}});
  const ShapeId deadShape = world.shapes(deadBody)[0];
  const JointId deadJoint = world.create(BallJoint{.bodyA = deadBody});
  world.destroy(deadBody);
  EXPECT_FALSE(world.isAlive(deadBody) || world.isAlive(deadShape) || world.isAlive(deadJoint));
  // The slots are taken again: the old ids must not reach what is there now.
  const BodyId next = world.create(BodyDef{.shape = Box{}});
  EXPECT_EQ(next.index, deadBody.index);
  world.create(BallJoint{.bodyA = next});
  const auto expectRefused = [&](auto id, const char* what) {
    useEverywhere(world, id, [&](const char* name, const std::function<void()>& call) {
      const std::string text =
          id ? std::to_string(id.index) + " (generation " + std::to_string(id.generation) + ")" : std::string("null");
      const bool onBody = name == std::string("create");
      refuse(call, "World::" + std::string(name), onBody ? "body" : "id", text,
             "must name a living " + std::string(what) + " of this world");
    });
  };
  for (const BodyId id : {deadBody, foreignBody, BodyId{}, BodyId{0xffffffffu, 1}}) expectRefused(id, "body");
  for (const ShapeId id : {deadShape, foreignShape, ShapeId{}, ShapeId{0xffffffffu, 0}}) expectRefused(id, "shape");
  for (const JointId id : {deadJoint, JointId{77, 1}, JointId{}, JointId{0xffffffffu, 0}}) expectRefused(id, "joint");
}

TEST_F(Refusal, JointOfAnotherType) {
  refuse([&] { world.fixedJoint(joint); }, "World::fixedJoint", "id", "1 (generation 1)", "must name a fixed joint");
  refuse([&] { world.tetVolume(joint); }, "World::tetVolume", "id", "1 (generation 1)", "must name a tet volume");
  const JointId fixed = world.create(FixedJoint{.bodyA = ball});
  refuse([&] { world.ballJoint(fixed); }, "World::ballJoint", "id", "2 (generation 1)", "must name a ball joint");
}

}  // namespace
}  // namespace avbd
