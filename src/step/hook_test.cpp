// The contact hook: refusing, coefficients, belts, scaled masses, and answers that may not be given.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;
constexpr float kGravity = 9.81f;

BodyId addHooked(World& world, const BodyDef& def, const Geometry& shape, const Material& material = {}) {
  BodyDef body = def;
  body.shapes.push_back({.geometry = shape, .material = material, .contactHook = true});
  return world.create(body);
}
BodyId addGround(World& world, const Material& material = {}) {
  return world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}, .material = material});
}
Vec3 forceOn(const World& world, BodyId id) {
  Vec3 sum;
  for (const Contact& contact : world.contacts())
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& point = contact.points[static_cast<size_t>(i)];
      const Vec3 onB = contact.normal * point.normalForce + point.frictionForce;
      if (contact.bodyB == id) sum = sum + onB;
      if (contact.bodyA == id) sum = sum - onB;
    }
  return sum;
}

TEST(Hook, SeesItsContactsAndOnlyThose) {
  World world;
  const BodyId ground = addGround(world);
  const BodyId seen = addHooked(world, BodyDef{.position = {0, 0.51, 0}, .linearVelocity = {1, 0, 0}}, Box{});
  world.create(BodyDef{.position = {5, 0.5, 0}, .shape = Box{}});
  int calls = 0;
  world.setContactHook([&](ContactPlan& plan) {
    ++calls;
    EXPECT_EQ(plan.bodyA, ground);
    EXPECT_EQ(plan.bodyB, seen);
    EXPECT_EQ(plan.pointCount, 4);
    EXPECT_NEAR(plan.normal.y, 1, 1e-6);
    EXPECT_NEAR(plan.velocities[0].x, 1, 1e-6);
    EXPECT_NEAR(plan.separations[0], 0.01, 1e-5);
    EXPECT_NEAR(plan.positions[0].y, 0.005, 1e-5);
    EXPECT_EQ(plan.friction, 0.5f);
    EXPECT_EQ(plan.elementA, kNoElement);
    return true;
  });
  world.step(kDt);
  EXPECT_EQ(calls, 1);
  world.setContactHook({});
  world.step(kDt);
  EXPECT_EQ(calls, 1);
}

TEST(Hook, AnAnswerThatChangesNothingChangesNoBit) {
  World with, without;
  for (World* world : {&with, &without}) {
    addGround(*world);
    for (int i = 0; i < 6; ++i)
      addHooked(*world, BodyDef{.position = {0.1 * i, 0.6 + 1.1 * i, 0}, .linearVelocity = {0, 0, 1}}, Box{});
  }
  with.setContactHook([](ContactPlan&) { return true; });
  for (int i = 0; i < 60; ++i) with.step(kDt), without.step(kDt);
  EXPECT_EQ(with.hash(), without.hash());
}

TEST(Hook, WhatItRefusesIsNoContact) {
  World world;
  addGround(world);
  const BodyId ghost = addHooked(world, BodyDef{.position = {0, 1, 0}}, Box{});
  const BodyId solid = world.create(BodyDef{.position = {5, 0.5, 0}, .shape = Box{}, .canSleep = false});
  world.setContactHook([](ContactPlan&) { return false; });
  for (int i = 0; i < 60; ++i) {
    world.step(kDt);
    EXPECT_TRUE(world.events().begins.empty() || world.events().begins[0].bodyB == solid);
  }
  EXPECT_NEAR(world.pose(ghost).position.y, 1 - 0.5 * kGravity, 0.1);
  EXPECT_NEAR(world.pose(solid).position.y, 0.5, 3e-3);
  EXPECT_EQ(world.contacts().size(), 1u);
  EXPECT_EQ(world.report().contacts, 1u);
}

TEST(Hook, AOneWayPlatform) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .position = {0, 2, 0}, .shape = Box{2, 0.1f, 2}});
  const BodyId ball = addHooked(world, BodyDef{.linearVelocity = {0, 9, 0}}, Sphere{0.3f});
  world.setContactHook([](ContactPlan& plan) {
    // Platform is A. Only from above, and not while it still goes up.
    return plan.normal.y > 0.5f && plan.velocities[0].y < 0.1f && plan.separations[0] > -0.1f;
  });
  double highest = 0;
  for (int i = 0; i < 180; ++i) {
    world.step(kDt);
    highest = std::max(highest, world.pose(ball).position.y);
  }
  EXPECT_GT(highest, 3.5);
  EXPECT_NEAR(world.pose(ball).position.y, 2.4, 3e-3);
}

TEST(Hook, ChangesFriction) {
  World world;
  addGround(world);
  const BodyId box =
      addHooked(world, BodyDef{.position = {0, 0.2, 0}, .linearVelocity = {4, 0, 0}}, Box{0.3f, 0.2f, 0.3f});
  world.setContactHook([](ContactPlan& plan) {
    plan.staticFriction = plan.friction = 0.25f;
    return true;
  });
  for (int i = 0; i < 150; ++i) world.step(kDt);
  EXPECT_NEAR(world.pose(box).position.x, 16 / (2 * 0.25 * kGravity), 0.05);
}

// ---- Belts -----------------------------------------------------------------------------------------------------

std::function<bool(ContactPlan&)> belt(BodyId ground, Vec3 velocity) {
  return [=](ContactPlan& plan) {
    if (plan.bodyA == ground) plan.surfaceVelocity = velocity;
    if (plan.bodyB == ground) plan.surfaceVelocity = -velocity;
    return true;
  };
}

TEST(Belt, TakesABoxToItsSpeed) {
  World world;
  const BodyId ground = addGround(world, {.friction = 0.5f});
  const BodyId box = addHooked(world, BodyDef{.position = {0, 0.2, 0}}, Box{0.3f, 0.2f, 0.3f}, {.friction = 0.5f});
  world.setContactHook(belt(ground, {1, 0.7f, 0}));
  // First it slides, at mu g.
  for (int i = 0; i < 6; ++i) world.step(kDt);
  EXPECT_NEAR(world.velocity(box).linear.x, 0.5 * kGravity * 0.1, 0.05);
  EXPECT_NEAR(forceOn(world, box).x, 0.5f * world.mass(box) * kGravity, 0.05f * world.mass(box) * kGravity);
  for (int i = 0; i < 54; ++i) world.step(kDt);
  EXPECT_NEAR(world.velocity(box).linear.x, 1, 0.01);
  EXPECT_NEAR(world.velocity(box).linear.y, 0, 1e-3);
  const double at = world.pose(box).position.x;
  for (int i = 0; i < 120; ++i) world.step(kDt);
  EXPECT_NEAR(world.pose(box).position.x - at, 2, 0.01);
  EXPECT_LT(std::fabs(forceOn(world, box).x), 0.01f * world.mass(box) * kGravity);
}

TEST(Belt, AWallHoldsWhatItCarriesWithTheFrictionForce) {
  World world;
  const BodyId ground = addGround(world, {.friction = 0.4f});
  const BodyId wall = world.create(
      BodyDef{.type = BodyType::Static, .position = {1, 0, 0}, .shape = Box{0.5f, 3, 3}, .material = {.friction = 0}});
  const BodyId box = addHooked(world, BodyDef{.position = {0.1, 0.2, 0}}, Box{0.3f, 0.2f, 0.3f}, {.friction = 0.4f});
  world.setContactHook(belt(ground, {1, 0, 0}));
  for (int i = 0; i < 120; ++i) world.step(kDt);
  EXPECT_LT(length(world.velocity(box).linear), 0.01f);
  Vec3 byWall;
  for (const Contact& c : world.contacts())
    for (int i = 0; i < c.pointCount; ++i)
      if (c.bodyA == wall) byWall = byWall + c.normal * c.points[static_cast<size_t>(i)].normalForce;
  EXPECT_NEAR(byWall.x, -0.4f * world.mass(box) * kGravity, 0.01f * world.mass(box) * kGravity);
}

// ---- Scaled masses ---------------------------------------------------------------------------------------------

struct Scaled {
  float massA, massB, scaleA, scaleB, restitution;
};
void PrintTo(const Scaled& s, std::ostream* out) {
  *out << s.massA << " kg x" << s.scaleA << " against " << s.massB << " kg x" << s.scaleB << ", e " << s.restitution;
}
class HeadOn : public testing::TestWithParam<std::tuple<Scaled, PrimalSolver>> {};

// Each inverse mass counts as s times itself: the outcome is that of a body of mass m / s. With so many iterations that
// only the contact's meaning is left.
TEST_P(HeadOn, EndsAsWithTheScaledMasses) {
  const Scaled s = std::get<0>(GetParam());
  World world({.gravity = {}, .iterations = 20, .primalSolver = std::get<1>(GetParam())});
  const auto ball = [&](double x, float speed, float mass) {
    return addHooked(world, BodyDef{.position = {x, 0, 0}, .linearVelocity = {speed, 0, 0}, .mass = mass}, Sphere{0.5f},
                     {.friction = 0, .restitution = s.restitution});
  };
  const BodyId a = ball(-1, 3, s.massA), b = ball(1, -2, s.massB);
  world.setContactHook([&](ContactPlan& plan) {
    EXPECT_EQ(plan.bodyA, a);
    plan.inverseMassScaleA = s.scaleA, plan.inverseMassScaleB = s.scaleB;
    return true;
  });
  for (int i = 0; i < 40; ++i) world.step(kDt);
  const double wA = s.scaleA / s.massA, wB = s.scaleB / s.massB;
  const double impulse = wA + wB > 0 ? (1 + s.restitution) * 5 / (wA + wB) : 0;
  EXPECT_NEAR(world.velocity(a).linear.x, 3 - impulse * wA, 0.03);
  EXPECT_NEAR(world.velocity(b).linear.x, -2 + impulse * wB, 0.03);
}

INSTANTIATE_TEST_SUITE_P(
    Scales, HeadOn,
    testing::Combine(testing::Values(Scaled{1, 1, 0, 1, 0}, Scaled{1, 1, 1, 0, 0}, Scaled{1, 1, 2, 1, 0},
                                     Scaled{1, 1, 2, 2, 0}, Scaled{1, 1, 10, 1, 0}, Scaled{5, 1, 0.1f, 1, 0},
                                     Scaled{1, 20, 1, 0, 0}, Scaled{1, 20, 4, 0.5f, 0}, Scaled{1, 1, 0, 1, 0.8f},
                                     Scaled{1, 1, 2, 1, 0.8f}, Scaled{1, 1, 0, 0, 0}),
                     testing::Values(PrimalSolver::Krylov, PrimalSolver::BlockSweep)));

TEST(MassScale, AStackStandsOnABodyThatItDoesNotPress) {
  World world;
  addGround(world);
  BodyId box[4];
  for (int i = 0; i < 4; ++i)
    box[i] = addHooked(world, BodyDef{.position = {0, 0.25 + 0.5 * i, 0}, .mass = i == 3 ? 50.0f : 1.0f},
                       Box{0.25f, 0.25f, 0.25f});
  // Each carries the one above as a rock would.
  world.setContactHook([&](ContactPlan& plan) {
    if (world.type(plan.bodyA) == BodyType::Dynamic) plan.inverseMassScaleA = 0;
    return true;
  });
  for (int i = 0; i < 180; ++i) world.step(kDt);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(world.pose(box[i]).position.y, 0.25 + 0.5 * i, 8e-3) << i;
  EXPECT_LT(length(world.velocity(box[3]).linear), 2e-3);
  for (const Contact& c : world.contacts()) {
    float normal = 0;
    for (int i = 0; i < c.pointCount; ++i) normal += c.points[static_cast<size_t>(i)].normalForce;
    EXPECT_NEAR(normal, world.mass(c.bodyB) * kGravity, 0.02f * world.mass(c.bodyB) * kGravity);
  }
}

// ---- Answers that may not be given -----------------------------------------------------------------------------

struct Refused {
  const char* field;
  void (*change)(ContactPlan&);
};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const Refused kRefused[] = {
    {"friction", [](ContactPlan& p) { p.friction = -1; }},
    {"friction", [](ContactPlan& p) { p.friction = kNan; }},
    {"staticFriction", [](ContactPlan& p) { p.staticFriction = 0.5f * p.friction; }},
    {"staticFriction", [](ContactPlan& p) { p.staticFriction = kNan; }},
    {"restitution", [](ContactPlan& p) { p.restitution = 1.5f; }},
    {"torsionalFriction", [](ContactPlan& p) { p.torsionalFriction = -0.1f; }},
    {"rollingFriction", [](ContactPlan& p) { p.rollingFriction = INFINITY; }},
    {"surfaceVelocity", [](ContactPlan& p) { p.surfaceVelocity.z = kNan; }},
    {"inverseMassScaleA", [](ContactPlan& p) { p.inverseMassScaleA = -1; }},
    {"inverseMassScaleB", [](ContactPlan& p) { p.inverseMassScaleB = 1001; }},
};

TEST(Refusal, NamesTheFieldAndChangesNothing) {
  for (const Refused& refused : kRefused)
    for (const int substeps : {1, 3}) {
      World world({.substeps = substeps}), twin({.substeps = substeps});
      int calls = 0, failAt = 1 << 30;
      for (World* w : {&world, &twin}) {
        addGround(*w);
        for (int i = 0; i < 3; ++i)
          addHooked(*w, BodyDef{.position = {0.1 * i, 0.5 + 1.01 * i, 0}, .linearVelocity = {0, 0, 1}}, Box{});
        w->setContactHook([&, w](ContactPlan& plan) {
          if (w == &world && ++calls == failAt) refused.change(plan);
          return true;
        });
        for (int i = 0; i < 20; ++i) w->step(kDt);
      }
      const uint64_t before = world.hash();
      // In the last substep, behind others that went well.
      const int contacts = static_cast<int>(world.contacts().size());
      failAt = calls + (substeps - 1) * contacts + 2;
      try {
        world.step(kDt);
        ADD_FAILURE() << refused.field << " went through";
      } catch (const Error& error) {
        EXPECT_EQ(error.definition(), "ContactPlan");
        EXPECT_EQ(error.field().substr(0, std::string(refused.field).size()), refused.field);
        EXPECT_FALSE(error.range().empty());
      }
      EXPECT_EQ(world.hash(), before) << refused.field << ", " << substeps;
      EXPECT_EQ(world.time(), twin.time());
      for (int i = 0; i < 10; ++i) world.step(kDt), twin.step(kDt);
      EXPECT_EQ(world.hash(), twin.hash()) << refused.field << ", " << substeps;
    }
}

TEST(Refusal, KeepsTheForcesThatWereGiven) {
  World world, twin;
  BodyId box[2];
  bool bad = true;
  for (World* w : {&world, &twin}) {
    addGround(*w);
    box[w == &twin] = addHooked(*w, BodyDef{.position = {0, 0.5, 0}}, Box{}, {.friction = 0});
    w->setContactHook([&, w](ContactPlan& plan) {
      if (w == &world && bad) plan.friction = -1;
      return true;
    });
    w->addForce(box[w == &twin], {100, 0, 0});
  }
  EXPECT_THROW(world.step(kDt), Error);
  bad = false;
  world.step(kDt), twin.step(kDt);
  EXPECT_GT(world.velocity(box[0]).linear.x, 0);
  EXPECT_EQ(world.hash(), twin.hash());
}

TEST(Hook, AShapeMayAskForItLater) {
  World world;
  addGround(world);
  const BodyId box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}});
  const ShapeId shape = world.shapes(box)[0];
  int calls = 0;
  bool bad = false;
  world.setContactHook([&](ContactPlan& plan) {
    if (bad) plan.friction = -1;
    return ++calls > 0;
  });
  world.step(kDt);
  EXPECT_EQ(calls, 0);
  world.setContactHook(shape, true);
  EXPECT_TRUE(world.contactHook(shape));
  world.step(kDt);
  EXPECT_EQ(calls, 1);
  const uint64_t hash = world.hash();
  bad = true;
  EXPECT_THROW(world.step(kDt), Error);
  EXPECT_EQ(world.hash(), hash);
  world.setContactHook(shape, false);
  world.step(kDt);
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace avbd
