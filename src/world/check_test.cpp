// Every field of every definition is refused outside its range, with a message that names all four parts.
#include "world/check.h"

#include <avbd/height_field.h>
#include <avbd/mesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/lane_width.h"
#include "world/bodies.h"
#include "world/joints.h"

namespace avbd {
namespace {

const float kNan = std::nanf(""), kInf = std::numeric_limits<float>::infinity();

void expectError(const std::function<void()>& call, const std::string& definition, const std::string& field,
                 const std::string& value, const std::string& range) {
  try {
    call();
    ADD_FAILURE() << definition << "." << field << " = " << value << " was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.definition(), definition);
    EXPECT_EQ(error.field(), field);
    EXPECT_EQ(error.value(), value);
    EXPECT_NE(error.range().find(range), std::string::npos) << field << ": " << error.range();
    EXPECT_EQ(error.what(), definition + "." + field + " = " + value + ": " + error.range());
  }
}

void refuseBody(const std::function<void(BodyDef&)>& change, const std::string& field, const std::string& value,
                const std::string& range) {
  BodyDef def{.shape = Box{}};
  change(def);
  expectError([&] { checkedBody(def, 1); }, "BodyDef", field, value, range);
}

TEST(Path, ReadsAsTheUserWouldWriteIt) {
  const Path root("BodyDef");
  const Path shapes = root / "shapes";
  const Path shape = shapes[2];
  const Path geometry = shape / "geometry";
  expectError([&] { (geometry / "radius").refuse("-1", "no"); }, "BodyDef", "shapes[2].geometry.radius", "-1", "no");
}

TEST(Range, Text) {
  EXPECT_EQ(toText(positive(1e6)), "must be finite and > 0 and at most 1e+06");
  EXPECT_EQ(toText(notNegative(1e6)), "must be finite and >= 0 and at most 1e+06");
  EXPECT_EQ(toText(symmetric(10)), "must be finite and between -10 and 10");
}

TEST(Range, EndsAreInside) {
  const Path path("X");
  check(path / "a", 0.1f, Range{0.1, 0.3});
  check(path / "a", 0.3f, Range{0.1, 0.3});
  check(path / "a", 0.0f, notNegative(1));
  expectError([&] { check(path / "a", 0.0f, positive(1)); }, "X", "a", "0", "> 0");
  expectError([&] { check(path / "a", std::nextafter(1.0f, 2.0f), positive(1)); }, "X", "a", "1.0000001", "at most 1");
}

TEST(CheckBody, DefaultIsFineAndKeepsItsBits) {
  const BodyPlan plan = checkedBody({.position = {1, 2, 3}, .shape = Box{}}, 1);
  EXPECT_EQ(plan.pose, (Pose{{1, 2, 3}, {}}));
  ASSERT_EQ(plan.shapes.size(), 1u);
  EXPECT_FLOAT_EQ(plan.mass.mass, 1000);
}

TEST(CheckBody, RotationIsMadeExact) {
  const BodyPlan plan = checkedBody({.rotation = {1.0009f, 0, 0, 0}, .shape = Box{}}, 1);
  EXPECT_EQ(plan.pose.rotation, Quat{});
  const Quat exact = checkedRotation(Path("X"), {0.6f, 0, 0.8f, 0});
  EXPECT_EQ(exact, (Quat{0.6f, 0, 0.8f, 0}));
  // What was made exact once stays.
  for (int i = 0; i < 1000; ++i) {
    const float a = 0.01f * static_cast<float>(i);
    const Quat q = checkedRotation(
        Path("X"), {std::cos(a) * 1.0005f, std::sin(a) * 1.0005f * 0.6f, 0, std::sin(a) * 1.0005f * 0.8f});
    EXPECT_EQ(checkedRotation(Path("X"), q), q);
    EXPECT_NEAR(double(q.w) * q.w + double(q.x) * q.x + double(q.z) * q.z, 1, 2.5e-7);
  }
}

TEST(CheckBody, PoseAndMotion) {
  refuseBody([](BodyDef& d) { d.position.x = std::nan(""); }, "position", "(nan, 0, 0)", "between -1e+09 and 1e+09");
  refuseBody([](BodyDef& d) { d.position.y = 1.1e9; }, "position", "(0, 1.1e+09, 0)", "between -1e+09 and 1e+09");
  refuseBody([](BodyDef& d) { d.rotation = {0, 0, 0, 0}; }, "rotation", "(0, 0, 0, 0)", "within 0.001 of 1");
  refuseBody([](BodyDef& d) { d.rotation = {1.002f, 0, 0, 0}; }, "rotation", "(1.002, 0, 0, 0)", "within 0.001 of 1");
  refuseBody([](BodyDef& d) { d.rotation.x = kNan; }, "rotation", "(1, nan, 0, 0)", "within 0.001 of 1");
  refuseBody([](BodyDef& d) { d.rotation.z = kInf; }, "rotation", "(1, 0, 0, inf)", "within 0.001 of 1");
  refuseBody([](BodyDef& d) { d.linearVelocity.z = kInf; }, "linearVelocity", "(0, 0, inf)", "must be finite");
  refuseBody([](BodyDef& d) { d.angularVelocity.z = 2e6f; }, "angularVelocity", "(0, 0, 2e+06)", "must be finite");
  refuseBody([](BodyDef& d) { d.linearDamping = -1; }, "linearDamping", "-1", ">= 0");
  refuseBody([](BodyDef& d) { d.angularDamping = kNan; }, "angularDamping", "nan", ">= 0");
  refuseBody([](BodyDef& d) { d.gravityScale = kInf; }, "gravityScale", "inf", "must be finite");
  refuseBody([](BodyDef& d) { d.locks = 64; }, "locks", "64", "0 .. 63");
  refuseBody([](BodyDef& d) { d.maxLinearSpeed = 0; }, "maxLinearSpeed", "0", "> 0");
  refuseBody([](BodyDef& d) { d.maxLinearSpeed = kNan; }, "maxLinearSpeed", "nan", "> 0");
  refuseBody([](BodyDef& d) { d.maxAngularSpeed = -3; }, "maxAngularSpeed", "-3", "> 0");
  refuseBody([](BodyDef& d) { d.type = static_cast<BodyType>(7); }, "type", "7", "Static, Kinematic or Dynamic");
  refuseBody(
      [](BodyDef& d) {
        d.type = BodyType::Static;
        d.linearVelocity.x = 1;
      },
      "linearVelocity", "(1, 0, 0)", "zero on a static body");
  refuseBody(
      [](BodyDef& d) {
        d.type = BodyType::Static;
        d.angularVelocity.x = 1;
      },
      "angularVelocity", "(1, 0, 0)", "zero on a static body");
}

TEST(CheckBody, Mass) {
  refuseBody([](BodyDef& d) { d.mass = kNan; }, "mass", "nan", "must be finite and >= 0");
  refuseBody([](BodyDef& d) { d.mass = -1; }, "mass", "-1", "must be finite and >= 0");
  refuseBody([](BodyDef& d) { d.mass = 1e-30f; }, "mass", "1e-30", "must give a mass of 1e-24 to 1e+18 kg");
  refuseBody([](BodyDef& d) { d.density = 0; }, "density", "0", "must give a dynamic body mass");
  refuseBody([](BodyDef& d) { d.density = kNan; }, "density", "nan", ">= 0");
  refuseBody([](BodyDef& d) { d.density = 1e13f; }, "density", "1e+13", "at most 1e+12");
  refuseBody([](BodyDef& d) { d.density = 1e-29f; }, "density", "1e-29", "must give a mass of 1e-24");
  refuseBody([](BodyDef& d) { d.shape = Box{1e5f, 1e5f, 1e5f}; }, "density", "8e+18", "to 1e+18 kg");
  refuseBody([](BodyDef& d) { d.shape.reset(); }, "massProperties", "nothing", "must be given");
  refuseBody(
      [](BodyDef& d) {
        d.shape.reset();
        d.mass = 3;
      },
      "massProperties", "nothing", "must be given");
  refuseBody(
      [](BodyDef& d) {
        d.shape.reset();
        d.shapes = {{.density = 0}, {.density = 0}};
      },
      "shapes", "0", "must give a dynamic body mass");
}

TEST(CheckBody, GivenMass) {
  const auto refuse = [](MassProperties mass, const std::string& field, const std::string& value,
                         const std::string& range) {
    refuseBody([&](BodyDef& d) { d.massProperties = mass; }, "massProperties." + field, value, range);
  };
  refuse({.mass = 0}, "mass", "0", "must be finite and >= 1e-24");
  refuse({.mass = kNan}, "mass", "nan", "must be finite");
  refuse({.mass = kInf}, "mass", "inf", "must be finite");
  refuse({.center = {0, kNan, 0}}, "center", "(0, nan, 0)", "must be finite");
  refuse({.inertia = {1, 1, 0, 0, 0, 0}}, "inertia", "(1, 1, 0)", ">= 1e-34");
  refuse({.inertia = {1, kNan, 1, 0, 0, 0}}, "inertia", "(1, nan, 1)", "must be finite");
  refuse({.inertia = {1, 1, 1, 0, kNan, 0}}, "inertia", "(0, nan, 0)", "must be finite");
  refuse({.inertia = {1, 1, 1, 1.5f, 0, 0}}, "inertia", "(1, 1, 1, 1.5, 0, 0)", "positive definite");
  refuse({.inertia = {1, 1, 2.1f, 0, 0, 0}}, "inertia", "(1, 1, 2.1, 0, 0, 0)", "sum of the other two");
  // A flat plate is the limit of what is possible.
  const MassProperties plate{.inertia = {1, 1, 2, 0, 0, 0}};
  EXPECT_NO_THROW(checkedBody({.massProperties = plate}, 1));
}

TEST(CheckBody, Shapes) {
  refuseBody([](BodyDef& d) { d.shape = Sphere{0}; }, "shape.radius", "0", ">= 1e-06 and at most 1e+06");
  refuseBody([](BodyDef& d) { d.shape = Sphere{kNan}; }, "shape.radius", "nan", ">= 1e-06");
  refuseBody([](BodyDef& d) { d.shape = Sphere{2e6f}; }, "shape.radius", "2e+06", "at most 1e+06");
  refuseBody([](BodyDef& d) { d.shape = Capsule{-1, 1}; }, "shape.radius", "-1", ">= 1e-06");
  refuseBody([](BodyDef& d) { d.shape = Capsule{1, -1}; }, "shape.halfHeight", "-1", ">= 0");
  refuseBody([](BodyDef& d) { d.shape = Capsule{1, kInf}; }, "shape.halfHeight", "inf", ">= 0");
  refuseBody([](BodyDef& d) { d.shape = Box{0, 1, 1}; }, "shape.x", "0", ">= 1e-06");
  refuseBody([](BodyDef& d) { d.shape = Box{1, -2, 1}; }, "shape.y", "-2", ">= 1e-06");
  refuseBody([](BodyDef& d) { d.shape = Box{1, 1, kNan}; }, "shape.z", "nan", ">= 1e-06");
  refuseBody([](BodyDef& d) { d.shape = HalfSpace{}; }, "shape", "HalfSpace", "bounded on a dynamic body");
  refuseBody([](BodyDef& d) { d.material.friction = -1; }, "material.friction", "-1", ">= 0");
  refuseBody([](BodyDef& d) { d.material.staticFriction = 0.4f; }, "material.staticFriction", "0.4", ">= friction");
  refuseBody([](BodyDef& d) { d.material.staticFriction = kNan; }, "material.staticFriction", "nan", "must be -1");
  refuseBody([](BodyDef& d) { d.material.staticFriction = kInf; }, "material.staticFriction", "inf", "at most");
  refuseBody([](BodyDef& d) { d.material.restitution = 1.1f; }, "material.restitution", "1.1", "at most 1");
  refuseBody([](BodyDef& d) { d.material.frictionCombine = static_cast<Combine>(9); }, "material.frictionCombine", "9",
             "must be a value of Combine");
  refuseBody([](BodyDef& d) { d.material.restitutionCombine = static_cast<Combine>(9); }, "material.restitutionCombine",
             "9", "must be a value of Combine");
}

TEST(CheckBody, NestedShapes) {
  const auto refuse = [](ShapeDef shape, const std::string& field, const std::string& value, const std::string& range) {
    refuseBody([&](BodyDef& d) { d.shapes = {{}, {}, shape}; }, "shapes[2]." + field, value, range);
  };
  refuse({.geometry = Sphere{-1}}, "geometry.radius", "-1", ">= 1e-06");
  refuse({.geometry = HalfSpace{}}, "geometry", "HalfSpace", "bounded on a dynamic body");
  refuse({.pose = {{0, 0, std::nan("")}, {}}}, "pose.position", "(0, 0, nan)", "must be finite");
  refuse({.pose = {{0, 2e6, 0}, {}}}, "pose.position", "(0, 2e+06, 0)", "between -1e+06 and 1e+06");
  refuse({.pose = {{}, {2, 0, 0, 0}}}, "pose.rotation", "(2, 0, 0, 0)", "within 0.001");
  refuse({.density = -1}, "density", "-1", ">= 0");
  refuse({.material = {.friction = kNan}}, "material.friction", "nan", ">= 0");
  EXPECT_NO_THROW(checkedBody({.type = BodyType::Static, .shapes = {{.geometry = HalfSpace{}}}}, 1));
  EXPECT_NO_THROW(checkedBody({.type = BodyType::Kinematic, .shape = HalfSpace{}}, 1));
}

// The triangles name more materials than there are.
TEST(CheckBody, MaterialsOfSurfaces) {
  const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}};
  const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  const std::vector<uint16_t> indices{0, 4};
  const std::vector<float> heights(9, 0);
  const std::vector<uint16_t> cells{1, 0, HeightFieldDef::kHole, 2};
  const Mesh mesh{makeMesh({.vertices = vertices, .triangles = triangles, .materials = indices})};
  const Mesh plain{makeMesh({.vertices = vertices, .triangles = triangles})};
  const HeightField field{makeHeightField({.columns = 3, .rows = 3, .heights = heights, .materials = cells})};
  const auto refuse = [](const Geometry& geometry, size_t count, const std::string& range) {
    const ShapeDef shape{.geometry = geometry, .materials = std::vector<Material>(count)};
    expectError([&] { checkedShape(Path("ShapeDef"), shape, BodyType::Static, 1); }, "ShapeDef", "materials",
                std::to_string(count) + " materials", range);
  };
  const auto accept = [](const Geometry& geometry, size_t count) {
    const ShapeDef shape{.geometry = geometry, .materials = std::vector<Material>(count)};
    EXPECT_NO_THROW(checkedShape(Path("ShapeDef"), shape, BodyType::Static, 1));
  };
  refuse(mesh, 4, "at least the 5 that the triangles of the Mesh name");
  refuse(field, 2, "at least the 3 that the triangles of the HeightField name");
  refuse(field, 65536, "at most 65535");
  accept(mesh, 0), accept(mesh, 5), accept(mesh, 9);
  accept(plain, 1), accept(field, 3), accept(Sphere{}, 1);
}

TEST(CheckBody, BoundsFollowTheLengthUnit) {
  EXPECT_NO_THROW(checkedBody({.position = {5e11, 0, 0}, .shape = Box{1e4f, 1e4f, 1e4f}, .density = 1e-6f}, 1000));
  EXPECT_THROW(checkedBody({.shape = Sphere{1e-4f}}, 1000), Error);
}

TEST(CheckWorld, EveryField) {
  const auto refuse = [](WorldDef def, const std::string& field, const std::string& value, const std::string& range) {
    expectError([&] { checkWorld(def); }, "WorldDef", field, value, range);
  };
  checkWorld({});
  refuse({.gravity = {0, kNan, 0}}, "gravity", "(0, nan, 0)", "must be finite");
  refuse({.gravity = {0, 1e7f, 0}}, "gravity", "(0, 1e+07, 0)", "between -1e+06 and 1e+06");
  refuse({.workers = 0}, "workers", "0", "1 .. 64");
  refuse({.workers = 65}, "workers", "65", "1 .. 64");
  refuse({.iterations = 0}, "iterations", "0", "1 .. 1000");
  refuse({.iterations = 1001}, "iterations", "1001", "1 .. 1000");
  refuse({.substeps = -5}, "substeps", "-5", "1 .. 1000");
  refuse({.lengthUnit = 0}, "lengthUnit", "0", ">= 1e-06");
  refuse({.lengthUnit = kNan}, "lengthUnit", "nan", ">= 1e-06");
  refuse({.restitutionThreshold = -1}, "restitutionThreshold", "-1", ">= 0");
  refuse({.maxDepenetrationSpeed = kInf}, "maxDepenetrationSpeed", "inf", ">= 0");
  refuse({.primalSolver = static_cast<PrimalSolver>(5)}, "primalSolver", "5", "Krylov or BlockSweep");
  refuse({.krylovIterations = -1}, "krylovIterations", "-1", "0 .. 1000");
  refuse({.simdWidth = 2}, "simdWidth", "2", "0, 1, 4, 8 or 16");
  refuse({.simdWidth = -1}, "simdWidth", "-1", "0, 1, 4, 8 or 16");
  for (const int width : {8, 16}) {
    if (laneWidthRuns(width)) continue;
    refuse({.simdWidth = width}, "simdWidth", toText(width), "this processor");
  }
  EXPECT_TRUE(laneWidthRuns(1));
  EXPECT_TRUE(laneWidthRuns(4));
  EXPECT_FALSE(laneWidthRuns(0));
}

class CheckJoint : public testing::Test {
 protected:
  BodyId make(BodyDef def) { return data.bodyIds.id(addBody(data, def, checkedBody(def, 1))); }
  template <class Def>
  void refuse(Def def, const std::string& name, const std::string& field, const std::string& value,
              const std::string& range) {
    expectError([&] { checkedJoint(data, def); }, name, field, value, range);
  }

  WorldData data;
  BodyId a = make({.shape = Box{}});
  BodyId b = make({.position = {1, 0, 0}, .shape = Box{}});
  BodyId c = make({.position = {0, 1, 0}, .shape = Box{}});
  BodyId d = make({.position = {0, 0, 1}, .shape = Box{}});
  BodyId ground = make({.type = BodyType::Static, .shape = HalfSpace{}});
  BodyId lift = make({.type = BodyType::Kinematic, .shape = Box{}});
};

TEST_F(CheckJoint, Bodies) {
  EXPECT_NO_THROW(checkedJoint(data, BallJoint{.bodyA = a}));
  EXPECT_NO_THROW(checkedJoint(data, BallJoint{.bodyB = a}));
  EXPECT_NO_THROW(checkedJoint(data, BallJoint{.bodyA = ground, .bodyB = a}));
  EXPECT_NO_THROW(checkedJoint(data, FixedJoint{.bodyA = lift, .bodyB = a}));
  refuse(BallJoint{}, "BallJoint", "bodyB", "null", "must differ from bodyA");
  refuse(BallJoint{.bodyA = a, .bodyB = a}, "BallJoint", "bodyB", "1 (generation 1)", "must differ from bodyA");
  refuse(BallJoint{.bodyA = a, .bodyB = {99, 1}}, "BallJoint", "bodyB", "99 (generation 1)", "must name a living body");
  refuse(BallJoint{.bodyA = {0, 5}, .bodyB = a}, "BallJoint", "bodyA", "null", "must name a living body");
  refuse(FixedJoint{.bodyA = {1, 2}, .bodyB = b}, "FixedJoint", "bodyA", "1 (generation 2)", "must name a living body");
  refuse(BallJoint{.bodyA = ground}, "BallJoint", "bodyB", "null", "must be dynamic where bodyA is not");
  refuse(BallJoint{.bodyA = ground, .bodyB = lift}, "BallJoint", "bodyB", "6 (generation 1)", "must be dynamic");
}

TEST_F(CheckJoint, Frames) {
  const Pose bad{{std::nan(""), 0, 0}, {}}, turned{{}, {0, 0, 0, 0.9f}}, far{{0, 2e6, 0}, {}};
  refuse(BallJoint{a, b, bad}, "BallJoint", "frameA.position", "(nan, 0, 0)", "must be finite");
  refuse(BallJoint{a, b, {}, turned}, "BallJoint", "frameB.rotation", "(0, 0, 0, 0.9)", "within 0.001 of 1");
  refuse(FixedJoint{a, b, {}, far}, "FixedJoint", "frameB.position", "(0, 2e+06, 0)", "between -1e+06 and 1e+06");
  // The world's frame may be anywhere in it.
  EXPECT_NO_THROW(checkedJoint(data, FixedJoint{a, {}, {}, far}));
}

TEST_F(CheckJoint, TetVolume) {
  EXPECT_FLOAT_EQ(checkedJoint(data, avbd::TetVolume{.bodies = {a, b, c, d}}).restVolume, 1.0f / 6);
  EXPECT_FLOAT_EQ(checkedJoint(data, avbd::TetVolume{.bodies = {a, c, b, d}}).restVolume, -1.0f / 6);
  using Tet = avbd::TetVolume;
  refuse(Tet{.bodies = {a, b, c}}, "TetVolume", "bodies[3]", "null", "must name a living body");
  refuse(Tet{.bodies = {a, b, b, d}}, "TetVolume", "bodies[2]", "2 (generation 1)", "must differ");
  refuse(Tet{.bodies = {a, lift, c, d}}, "TetVolume", "restVolume", "0", "lie in one plane");
  refuse(Tet{.bodies = {a, b, c, d}, .restVolume = kNan}, "TetVolume", "restVolume", "nan", "must be finite");
  refuse(Tet{.bodies = {a, b, c, d}, .restVolume = 1e28f}, "TetVolume", "restVolume", "1e+28", "between");
  refuse(Tet{.bodies = {a, b, c, d}, .stiffness = -1}, "TetVolume", "stiffness", "-1", ">= 0");
  const BodyId x = make({.position = {100, 0, 0}, .shape = Box{}}), y = make({.position = {0, 100, 0}, .shape = Box{}});
  const BodyId flat = make({.position = {30, 30, 1e-8}, .shape = Box{}});
  refuse(Tet{.bodies = {a, x, y, flat}}, "TetVolume", "restVolume", "0", "lie in one plane");
  const BodyId s1 = make({.type = BodyType::Static}), s2 = make({.type = BodyType::Static});
  refuse(Tet{.bodies = {ground, lift, s1, s2}}, "TetVolume", "bodies[0]", "5 (generation 1)", "must be dynamic");
}

}  // namespace
}  // namespace avbd
