// What contacts tell and how they are changed: begin and end, hard hits, a trigger, a conveyor belt, a one-way
// platform.
#include <avbd/avbd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
using namespace avbd;

namespace {

constexpr float kStep = 1.0f / 60;
constexpr float kBeltSpeed = 1.5f;

struct Place {
  BodyId belt, platform, crate, ball, zone;
};

/// A belt that carries a crate off its end, into a zone; a platform, and a ball thrown up from below it.
Place makePlace(World& world) {
  Place place;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  place.belt = world.create(BodyDef{
      .type = BodyType::Static, .position = {0, 1, 0}, .shapes = {{.geometry = Box{3, 0.1f, 1}, .contactHook = true}}});
  place.platform = world.create(BodyDef{
      .type = BodyType::Static, .position = {0, 2, 6}, .shapes = {{.geometry = Box{2, 0.1f, 2}, .contactHook = true}}});
  place.crate = world.create(
      BodyDef{.position = {-2, 1.35, 0}, .shapes = {{.geometry = Box{0.25f, 0.25f, 0.25f}, .hitEvents = true}}});
  place.ball = world.create(BodyDef{.position = {0, 0.5, 6}, .linearVelocity = {0, 9, 0}, .shape = Sphere{0.3f}});
  place.zone = world.create(BodyDef{.type = BodyType::Static,
                                    .position = {3.8, 0.5, 0},
                                    .shapes = {{.geometry = Box{0.6f, 0.5f, 1}, .isTrigger = true}}});
  return place;
}

/// The hook: called for each contact of the belt and of the platform, before it is solved.
bool change(const Place& place, ContactPlan& plan) {
  // surfaceVelocity is that of B's surface over A's: with the belt as A, things slide off along x.
  if (plan.bodyA == place.belt) plan.surfaceVelocity = {kBeltSpeed, 0, 0};
  if (plan.bodyB == place.belt) plan.surfaceVelocity = {-kBeltSpeed, 0, 0};
  const bool first = plan.bodyA == place.platform;
  if (!first && plan.bodyB != place.platform) return true;
  // Only what comes down from above is held; what rises, or hangs halfway through, passes.
  const float up = first ? plan.normal.y : -plan.normal.y;
  const float rising = first ? plan.velocities[0].y : -plan.velocities[0].y;
  return up > 0.5f && rising < 0.1f && plan.separations[0] > -0.1f;
}

bool check(bool good, const char* what) {
  std::printf("%-4s %s\n", good ? "yes" : "NO", what);
  return good;
}

}  // namespace

int main() {
  World world({.hitSpeed = 3});
  const Place place = makePlace(world);
  world.setContactHook([&place](ContactPlan& plan) { return change(place, plan); });

  bool rode = false, left = false, entered = false, hit = false;
  double highest = 0;
  float speedOnBelt = 0;
  for (int i = 0; i < 360; ++i) {
    world.step(kStep);
    const double t = world.time();
    const Events& events = world.events();
    for (const TouchEvent& e : events.begins)
      if (e.bodyA == place.belt) rode = true, std::printf("%.2f s: the crate touches the belt\n", t);
    for (const TouchEvent& e : events.ends)
      if (e.bodyA == place.belt) left = true, std::printf("%.2f s: it leaves the belt\n", t);
    for (const TriggerEvent& e : events.enters)
      if (e.visitorBody == place.crate) entered = true, std::printf("%.2f s: it enters the zone\n", t);
    for (const HitEvent& e : events.hits)
      hit = true,
      std::printf("%.2f s: it hits the ground at %.1f m/s with %.0f N s\n", t, double(e.speed), double(e.impulse));
    if (i == 120) speedOnBelt = world.velocity(place.crate).linear.x;
    highest = std::max(highest, world.pose(place.ball).position.y);
  }

  std::printf("on the belt the crate moves at %.3f m/s; the ball rose to %.2f m and lies at %.3f m\n",
              double(speedOnBelt), highest, world.pose(place.ball).position.y);
  for (const Contact& contact : world.contacts()) {
    float force = 0;
    for (int k = 0; k < contact.pointCount; ++k) force += contact.points[size_t(k)].normalForce;
    std::printf("a contact of %d points carries %.1f N\n", contact.pointCount, double(force));
  }
  bool good = check(rode && left, "the crate's contact with the belt began and ended");
  good &= check(std::abs(speedOnBelt - kBeltSpeed) < 0.02f, "it moved with the belt");
  good &= check(entered, "the trigger saw it");
  good &= check(hit, "its fall was a hit");
  good &= check(highest > 4, "the ball passed the platform from below");
  good &= check(std::abs(world.pose(place.ball).position.y - 2.4) < 0.01, "and lies on it");
  return good ? 0 : 1;
}
