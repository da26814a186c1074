// Impacts without restitution.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

struct Meeting {
  float speed = 0, ratio = 1;  ///< of B's mass to A's
  int phase = 0;               ///< where in a step they meet, in tenths of the way
  bool boxes = false;
  float gravity = 0;
};

/// How fast the bodies part in the steps after they met, of their speed of approach.
double parting(const Meeting& m) {
  World world({.gravity = {0, m.gravity, 0}});
  const double gap = 0.3 + 0.1 * m.phase * double{m.speed} * double{kDt};
  BodyDef a{.position = {-gap - 0.1, 0, 0}, .linearVelocity = {m.speed, 0, 0}, .shape = Sphere{0.1f}, .mass = 1};
  BodyDef b{.position = {0.1, 0, 0}, .shape = Sphere{0.1f}, .mass = m.ratio};
  if (m.boxes) a.shape = b.shape = Box{0.1f, 0.1f, 0.1f};
  const BodyId idA = world.create(a), idB = world.create(b);
  while (world.velocity(idB).linear.x == 0) world.step(kDt);
  double most = 0;
  for (int i = 0; i < 20; ++i) {
    world.step(kDt);
    most = std::max(most, double{world.velocity(idB).linear.x} - double{world.velocity(idA).linear.x});
  }
  return most / double{m.speed};
}

TEST(ContactImpact, BodiesThatMeetWithoutRestitutionStayTogether) {
  for (const float speed : {1.0f, 5.0f, 20.0f})
    for (const float ratio : {0.1f, 1.0f, 10.0f, 1000.0f})
      for (const bool boxes : {false, true})
        for (const float gravity : {0.0f, -9.81f})
          for (int phase = 0; phase < 10; ++phase)
            EXPECT_LT(parting({speed, ratio, phase, boxes, gravity}), 0.01)
                << speed << " m/s, mass ratio " << ratio << ", phase " << phase << (boxes ? " boxes" : " balls")
                << (gravity < 0 ? " falling" : "");
}

// What a landing leaves in the contacts must not lift the box.
TEST(ContactImpact, ABoxThatLandsStays) {
  for (const float speed : {1.0f, 5.0f}) {
    World world;
    world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    const BodyId box = world.create(BodyDef{
        .position = {0, 0.6, 0}, .linearVelocity = {0, -speed, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .canSleep = false});
    while (world.velocity(box).linear.y < -0.5f * speed) world.step(kDt);
    for (int i = 0; i < 60; ++i) {
      world.step(kDt);
      EXPECT_LT(world.velocity(box).linear.y, 0.01f * speed + 0.02f) << speed << " m/s, step " << i;
    }
  }
}

}  // namespace
}  // namespace avbd
