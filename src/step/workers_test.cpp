// The bits of a world do not depend on who computes them.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <thread>

namespace avbd {
namespace {

/// A heap of `layers` of 8 x 8 boxes, balls and capsules on the ground, some of them hung on others, and islands
/// beside.
World heap(const WorldDef& def, int layers) {
  World world(def);
  world.create(BodyDef{.type = BodyType::Static, .position = {0, -1, 0}, .shape = Box{50, 1, 50}});
  BodyId last{};
  for (int i = 0; i < 64 * layers; ++i) {
    const int column = i % 64;
    BodyDef body{.position = {1.02 * (column % 8) + 0.05 * (i / 64 % 3), 0.55 + 1.05 * (i / 64), 1.02 * (column / 8)},
                 .linearVelocity = {0.01f * static_cast<float>(i % 7), 0, 0.01f * static_cast<float>(i % 5)}};
    if (i % 11 == 3)
      body.shape = Sphere{0.5f};
    else if (i % 13 == 5)
      body.shape = Capsule{0.3f, 0.2f};
    else
      body.shape = Box{0.5f, 0.5f, 0.5f};
    if (i % 17 == 2) body.material.restitution = 0.5f;
    const BodyId id = world.create(body);
    if (i % 29 == 28)
      world.create(BallJoint{.bodyA = last, .bodyB = id, .frameA = {{0.5, 0, 0}, {}}, .frameB = {{-0.5, 0, 0}, {}}});
    last = id;
  }
  for (int i = 0; i < 150; ++i)
    world.create(BodyDef{.position = {-5.0 - 2 * (i % 15), 0.5, 2.0 * (i / 15)}, .shape = Box{0.5f, 0.5f, 0.5f}});
  return world;
}

std::vector<uint64_t> hashes(WorldDef def, int layers, int steps) {
  World world = heap(def, layers);
  std::vector<uint64_t> list;
  for (int i = 0; i < steps; ++i) {
    world.step(1.0f / 60);
    list.push_back(world.hash());
  }
  if (layers > 6) EXPECT_LT(world.report().islands, 250u);  // 150 lie alone: a large one is among them
  return list;
}

TEST(Workers, ChangeNoBitOfAHeap) {
  const std::vector<uint64_t> alone = hashes({}, 9, 25);
  for (const int workers : {2, 5, 8}) EXPECT_EQ(hashes({.workers = workers}, 9, 25), alone) << workers << " workers";
}

TEST(Workers, OfTheUserChangeNoneEither) {
  const std::vector<uint64_t> alone = hashes({}, 9, 20);
  std::vector<std::thread> threads;
  WorldDef def;
  def.tasks.workers = 3;
  def.tasks.run = [&](const std::function<void()>& help, int count) {
    for (int i = 0; i <= count; ++i) {
      if (threads.size() < 40)
        threads.emplace_back([help] {
          for (int k = 0; k < 50; ++k) help();
        });
      else
        help();
    }
  };
  EXPECT_EQ(hashes(def, 9, 20), alone);
  for (std::thread& thread : threads) thread.join();
}

TEST(Workers, ChangeNoBitOfTheBlockSweep) {
  WorldDef def{.primalSolver = PrimalSolver::BlockSweep};
  const std::vector<uint64_t> alone = hashes(def, 2, 10);
  def.workers = 4;
  EXPECT_EQ(hashes(def, 2, 10), alone);
}

TEST(Workers, MustBeAsManyAsThereAre) {
  TaskSystem tasks{0, [](const std::function<void()>&, int) {}};
  EXPECT_THROW(World({.tasks = tasks}), Error);
  tasks.workers = 65;
  EXPECT_THROW(World({.tasks = tasks}), Error);
  EXPECT_THROW(World({.workers = 0}), Error);
  EXPECT_THROW(World({.workers = -3}), Error);
  EXPECT_THROW(World({.workers = 1000}), Error);
}

}  // namespace
}  // namespace avbd
