// For the tests: a mover that falls, and things to walk on.
#pragma once

#include <avbd/mover.h>
#include <avbd/world.h>
#include <gtest/gtest.h>

#include <cmath>

namespace avbd {

inline constexpr float kStep = 1.0f / 60;

/// A walker who falls when nothing carries it.
struct Walker {
  World& world;
  Mover mover;

  Walker(World& w, const MoverDef& def) : world(w), mover(def) {}
  void walk(Vec3 wanted, int steps) {
    for (int i = 0; i < steps; ++i) {
      // In the air it keeps what the last move left it, and falls faster.
      Vec3 velocity = wanted;
      if (!mover.ground()) velocity.y = mover.velocity().y - 9.81f * kStep;
      if (!mover.ground() && wanted == Vec3{}) velocity = mover.velocity() - Vec3{0, 9.81f * kStep, 0};
      mover.move(world, velocity, kStep);
      const std::vector<NearHit> near = world.nearest(mover.geometry(), mover.pose(), 0, mover.definition().filter);
      for (const NearHit& hit : near) ASSERT_GT(hit.distance, -1e-3f) << "overlap at step " << i;
    }
  }
  Vec3d at() const { return mover.position(); }
};

inline BodyId fixedBox(World& world, Vec3d position, Box box, Quat rotation = {}) {
  return world.create(BodyDef{.type = BodyType::Static, .position = position, .rotation = rotation, .shape = box});
}

inline Quat aboutZ(double degrees) {
  const double half = degrees * 0.5 * 3.14159265358979 / 180;
  return {float(std::cos(half)), 0, 0, float(std::sin(half))};
}

}  // namespace avbd
