// What contacts and hits say of forces and impulses, against the velocities.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

BodyId addGround(World& world) { return world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}}); }
BodyId addBody(World& world, BodyDef def, const ShapeDef& shape) {
  def.shapes.push_back(shape);
  return world.create(def);
}
/// Of normal forces on a body in the last step, as an impulse.
double normalImpulse(const World& world, BodyId id) {
  double sum = 0;
  for (const Contact& c : world.contacts())
    for (int i = 0; i < c.pointCount; ++i)
      if (c.bodyA == id || c.bodyB == id) sum += double{c.points[static_cast<size_t>(i)].normalForce} * kDt;
  return sum;
}

// ---- Forces ----------------------------------------------------------------------------------------------------

/// What contacts, gravity and velocities say of a body in each step agrees: with substeps, rebounds, points that come
/// and go. With so many iterations that only the meaning of the forces is left.
void expectForcesExplainTheMotion(const Geometry& shape, const Material& material, int substeps) {
  World world({.iterations = 100, .substeps = substeps});
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}, .material = material});
  const BodyId id = addBody(
      world, BodyDef{.position = {0, 1, 0}, .linearVelocity = {3, 0, 1}, .angularVelocity = {1, 2, 4}, .mass = 1},
      {.geometry = shape, .material = material});
  int seen = 0;
  double worst = 0;
  for (int i = 0; i < 120; ++i) {
    const Vec3 before = world.velocity(id).linear;
    world.step(kDt);
    Vec3 gain = world.definition().gravity * kDt;
    for (const Contact& c : world.contacts()) {
      for (int k = 0; k < c.pointCount; ++k) {
        const ContactPoint& p = c.points[static_cast<size_t>(k)];
        gain = gain + (c.normal * p.normalForce + p.frictionForce) * kDt;
      }
      if (c.touch != TouchPhase::None) ++seen;
    }
    worst = std::max(worst, double{length(world.velocity(id).linear - before - gain)});
  }
  EXPECT_LT(worst, 0.02) << "shape " << shape.index() << ", e " << material.restitution << ", mu " << material.friction
                         << ", " << substeps << " substeps";
  EXPECT_GT(seen, 3);
}
TEST(Force, ExplainsTheMotion) {
  for (const int substeps : {1, 4})
    for (const float restitution : {0.0f, 0.6f})
      for (const float friction : {0.0f, 0.5f}) {
        expectForcesExplainTheMotion(Sphere{0.4f}, {.friction = friction, .restitution = restitution}, substeps);
        expectForcesExplainTheMotion(Box{0.3f, 0.2f, 0.4f}, {.friction = friction, .restitution = restitution},
                                     substeps);
      }
}

// ---- Hits ------------------------------------------------------------------------------------------------------

TEST(Hit, TellsSpeedAndImpulse) {
  for (const int substeps : {1, 4}) {
    World world({.substeps = substeps, .hitSpeed = 2});
    addGround(world);
    const BodyId ball =
        addBody(world, BodyDef{.position = {1, 1.5, 0}, .mass = 3}, {.geometry = Sphere{0.5f}, .hitEvents = true});
    std::vector<HitEvent> hits;
    double gained = 0;
    for (int i = 0; i < 120; ++i) {
      const float before = world.velocity(ball).linear.y;
      world.step(kDt);
      for (const HitEvent& hit : world.events().hits) hits.push_back(hit);
      if (!world.events().hits.empty()) gained = world.velocity(ball).linear.y - before + 9.81 * kDt;
    }
    ASSERT_EQ(hits.size(), 1u);
    const double speed = std::sqrt(2 * 9.81 * 1.0);
    EXPECT_NEAR(hits[0].speed, speed, 0.05 * speed);
    EXPECT_GT(gained, 0.1);
    EXPECT_NEAR(hits[0].impulse, 3 * gained, 1e-3 * 3 * gained);
    EXPECT_NEAR(hits[0].position.x, 1, 1e-3);
    EXPECT_NEAR(hits[0].position.y, 0, 0.05);
    EXPECT_NEAR(std::fabs(hits[0].normal.y), 1, 1e-6);
    EXPECT_EQ(hits[0].bodyB, ball);
  }
}

// Whenever in the step the touch falls, m (1 + e) v comes out, and what velocities and contacts say.
TEST(Hit, TellsTheImpulseOfABounce) {
  for (const int substeps : {1, 4})
    for (int k = 0; k < 12; ++k) {
      World world({.substeps = substeps});
      addGround(world);
      const double drop = 1 + 0.013 * k;
      const BodyId ball = addBody(world, BodyDef{.position = {0, 0.5 + drop, 0}, .mass = 3},
                                  {.geometry = Sphere{0.5f}, .material = {.restitution = 0.8f}, .hitEvents = true});
      std::vector<HitEvent> hits;
      while (hits.empty() && world.time() < 1) {
        const float before = world.velocity(ball).linear.y;
        world.step(kDt);
        hits = world.events().hits;
        if (hits.empty()) continue;
        const double gained = 3 * (double{world.velocity(ball).linear.y} - before + 9.81 * kDt);
        EXPECT_NEAR(hits[0].impulse, gained, 2e-3 * gained) << substeps << ", drop " << drop;
        EXPECT_NEAR(normalImpulse(world, ball), gained, 2e-3 * gained) << substeps << ", drop " << drop;
        const double speed = std::sqrt(2 * 9.81 * drop);
        EXPECT_NEAR(hits[0].impulse, 3 * 1.8 * speed, 0.03 * 3 * 1.8 * speed) << substeps << ", drop " << drop;
      }
      EXPECT_EQ(hits.size(), 1u);
    }
}

TEST(Hit, NotBelowTheSpeedAndNotWhereNobodyAsked) {
  for (const bool asked : {true, false}) {
    World world({.hitSpeed = asked ? 5.0f : 1.0f});
    addGround(world);
    addBody(world, BodyDef{.position = {1, 1.5, 0}, .mass = 3}, {.geometry = Sphere{0.5f}, .hitEvents = asked});
    for (int i = 0; i < 120; ++i) {
      world.step(kDt);
      EXPECT_TRUE(world.events().hits.empty());
    }
  }
}

}  // namespace
}  // namespace avbd
