// A character walks over stairs, up a slope, across a gap on a moving platform, and pushes a crate.
#include <avbd/avbd.h>

#include <cmath>
#include <cstdio>
using namespace avbd;

namespace {

void fixedBox(World& world, Vec3d position, Box box, Quat rotation = {}) {
  world.create(BodyDef{.type = BodyType::Static, .position = position, .rotation = rotation, .shape = box});
}

/// From x = 0: floor, ten steps of 0.25 m, a landing, a gap with a platform, a floor with a crate,
/// a slope of 30 degrees down.
BodyId makeCourse(World& world) {
  fixedBox(world, {-5, -0.5, 0}, {6, 0.5f, 3});
  for (int i = 0; i < 10; ++i)
    fixedBox(world, {1.2 + 0.4 * i, 0.125 * (i + 1) - 0.5, 0}, {0.2f, 0.125f * float(i + 1) + 0.5f, 3});
  fixedBox(world, {7, 2, 0}, {2, 0.5f, 3});
  fixedBox(world, {19, 2, 0}, {4, 0.5f, 3});
  const float angle = -0.5235988f;
  const Quat tilt{std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
  const Vec3 down = rotate(tilt, Vec3{3, -0.5f, 0});
  fixedBox(world, Vec3d{23, 2.5, 0} + down, {3, 0.5f, 3}, tilt);
  fixedBox(world, {32, -1, 0}, {4.5f, 0.5f, 3});
  world.create(BodyDef{.position = {18, 3, 0}, .shape = Box{0.4f, 0.4f, 0.4f}, .mass = 30});
  return world.create(BodyDef{.type = BodyType::Kinematic, .position = {10.5, 2.4, 0}, .shape = Box{1.4f, 0.1f, 2}});
}

}  // namespace

int main() {
  constexpr float kStep = 1.0f / 60;
  World world({.gravity = {0, -9.81f, 0}});
  const BodyId platform = makeCourse(world);
  Mover mover({.position = {-3, 0.02, 0}});

  for (int frame = 0; frame <= 1500 && mover.position().x < 30; ++frame) {
    // The platform waits for the character, who waits while it is carried across.
    const double x = world.pose(platform).position.x;
    const bool onPlatform = mover.ground().body == platform;
    const bool waits = onPlatform && mover.position().x > x && x < 13.5;
    world.setVelocity(platform, {{waits ? 1.0f : 0.0f, 0, 0}, {}});
    world.step(kStep);

    Vec3 velocity = waits ? Vec3{} : Vec3{2, 0, 0};
    if (!mover.ground()) velocity.y = mover.velocity().y - 9.81f * kStep;
    mover.move(world, velocity, kStep);

    if (frame % 60 == 0) {
      const Vec3d p = mover.position();
      const char* where = !mover.ground() ? "in the air" : onPlatform ? "on the platform" : "on the ground";
      std::printf("%5.1f s  x %6.2f  y %6.2f  speed %5.2f  %s\n", frame * double(kStep), p.x, p.y,
                  double(length(mover.velocity())), where);
    }
  }
  const bool arrived = mover.position().x >= 30 && mover.ground().onGround;
  std::printf("%s\n", arrived ? "arrived" : "did not arrive");
  return arrived ? 0 : 1;
}
