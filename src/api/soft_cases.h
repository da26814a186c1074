// What holds for worlds with soft bodies of any kind.
#pragma once

#include <avbd/world.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace avbd {

inline constexpr float kDt = 1.0f / 60;

inline void run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kDt);
}

/// Cloth that lies along x and z is turned over so that one half of it hangs above the other, by a bend of this radius.
inline void foldOver(World& world, SoftId cloth, double radius) {
  const double bend = 3.14159265358979323846 * radius;
  for (const BodyId id : world.particles(cloth)) {
    Pose pose = world.pose(id);
    const double x = pose.position.x;
    if (x <= 0) continue;
    pose.position.x = x < bend ? radius * std::sin(x / radius) : bend - x;
    pose.position.y += x < bend ? radius * (1 - std::cos(x / radius)) : 2 * radius;
    world.setPose(id, pose);
  }
}

/// make(def) gives the world.
template <class Make>
void expectSameBitsForAllWidthsAndWorkers(Make&& make, int steps) {
  std::set<uint64_t> hashes;
  for (const int width : {1, 4, 8, 16})
    for (const int workers : {1, 3}) {
      World world = make(WorldDef{.workers = workers, .simdWidth = width});
      run(world, steps);
      hashes.insert(world.hash());
    }
  EXPECT_EQ(hashes.size(), 1u);
}

/// A snapshot goes on as if nothing had been, in the same world and in another of the same making.
template <class Make>
void expectSnapshotGoesOn(Make&& make) {
  World world = make(WorldDef{}), other = make(WorldDef{});
  const size_t softs = world.softBodies().size();
  run(world, 20);
  std::vector<std::byte> bytes;
  world.save(bytes);
  run(world, 30);
  const uint64_t hash = world.hash();
  for (World* again : {&world, &other}) {
    again->restore(bytes);
    EXPECT_EQ(again->softBodies().size(), softs);
    run(*again, 30);
    EXPECT_EQ(again->hash(), hash);
  }
}

}  // namespace avbd
