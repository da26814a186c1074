// Every stage that shares its work, over every kind of thing, with many threads: the same bits, and nothing that two of
// them touch (./dev tsan).
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <bit>
#include <thread>

#include "api/snapshot_zoo.h"
#include "api/soft_cases.h"

namespace avbd {
namespace {

/// More of it than one piece of work: an island of several chunks, and many small ones that fall asleep.
class Crowd {
 public:
  explicit Crowd(WorldDef def) : zoo_(def) {
    zoo_.world.setContactHook(SnapshotZoo::slippery);
    addHeap();
    addSofts();
    const Geometry shapes[] = {Sphere{0.25f}, Box{0.25f, 0.25f, 0.25f}, Box{0.25f, 0.25f, 0.25f}};
    for (int i = 0; i < 144; ++i)
      loose_.push_back(
          zoo_.add({.position = {-18.0 + 1.2 * (i % 12), 0.25, 18.0 - 1.2 * (i / 12)}, .shape = shapes[i % 3]}));
  }

  /// Hashes of all steps, and what was told of soft bodies.
  std::vector<uint64_t> live(int steps) {
    std::vector<uint64_t> hashes;
    std::vector<std::byte> bytes;
    for (int i = 0; i < steps; ++i) {
      if (i == 8) shoot();
      if (i == 10) zoo_.world.save(bytes);
      if (i == 11) remove();
      if (i == 13) zoo_.world.restore(bytes);
      if (i == 14) zoo_.world.setGravity({1, -9, 0});
      zoo_.step();
      hashes.push_back(zoo_.world.hash());
      asleep_ = asleep_ || !zoo_.world.isAwake(loose_[1]);
      impacts_ += zoo_.world.report().impacts;
      addTold(hashes);
      lookAround();
    }
    return hashes;
  }

  bool slept() const { return asleep_; }
  uint64_t impacts() const { return impacts_; }
  bool touchedItself() const { return touchedItself_; }

 private:
  /// What contacts and events of soft bodies tell, which hashes of the world do not.
  void addTold(std::vector<uint64_t>& told) {
    const Events& events = zoo_.world.events();
    told.push_back(events.begins.size() << 32 | events.ends.size());
    for (const TouchEvent& e : events.begins)
      if (e.softA || e.softB) told.push_back(std::bit_cast<uint32_t>(e.impulse));
    for (const Contact& c : zoo_.world.contacts()) {
      if (!c.softA && !c.softB) continue;
      told.push_back(uint64_t{c.shapeA.index} << 32 | c.shapeB.index);
      told.push_back(std::bit_cast<uint64_t>(c.points[0].position.x));
      told.push_back(uint64_t{std::bit_cast<uint32_t>(c.points[0].normalForce)} << 32 | static_cast<uint32_t>(c.touch));
      touchedItself_ = touchedItself_ || c.softA == c.softB;
    }
  }

  void addHeap() {
    const Geometry shapes[] = {Box{0.3f, 0.3f, 0.3f}, Sphere{0.3f}, Capsule{0.2f, 0.1f}, Cylinder{0.3f, 0.3f}};
    BodyId last{};
    for (int i = 0; i < 420; ++i) {
      const BodyId body =
          zoo_.add({.position = {3 + 0.6 * (i % 10), 0.3 + 0.6 * (i / 100), 5 + 0.6 * (i / 10 % 10)},
                    .shapes = {{.geometry = shapes[i % 7 == 0 ? i % 4 : 0], .contactHook = i % 9 == 0}}});
      if (i % 31 == 30)
        zoo_.world.create(BallJoint{.bodyA = last, .bodyB = body, .frameA = {{0.3, 0, 0}}, .frameB = {{-0.3, 0, 0}}});
      last = body;
    }
  }

  /// Cloth that falls on itself, cloth over boxes and balls, solids that hardly change their volume.
  void addSofts() {
    World& world = zoo_.world;
    folded_ = world.create(SoftDef{.mesh = makeClothGrid(1, 0.4f, 24, 10), .pose = {{0, 0.011, -14}, {}}});
    foldOver(world, folded_, 0.03);
    for (int i = 0; i < 4; ++i)
      zoo_.add({.position = {6 + 0.4 * (i % 2), 0.15, -14 + 0.4 * (i / 2)},
                .shape = i % 2 ? Geometry(Sphere{0.15f}) : Geometry(Box{0.15f, 0.15f, 0.15f})});
    world.create(SoftDef{.mesh = makeClothGrid(1, 1, 14, 14),
                         .pose = {{6.2, 0.34, -13.8}, {}},
                         .material = {.damping = 0.01f, .maxStrain = 0.05f, .warp = {1, 0, 0}, .weftModulus = 3e4f}});
    for (int i = 0; i < 2; ++i)
      world.create(SoftDef{.mesh = makeTetBox({0.3f, 0.2f, 0.3f}, 4, 3, 4),
                           .pose = {{9 + 0.1 * i, 0.22 + 0.45 * i, -14}, {}},
                           .material = {.youngsModulus = 3e5f, .poissonRatio = 0.4999f, .damping = 0.02f}});
  }

  void shoot() {
    const Geometry shapes[] = {Sphere{0.1f}, Box{0.1f, 0.1f, 0.1f}};
    for (int i = 0; i < 60; ++i)
      zoo_.add({.position = {-18.0 + 0.4 * (i % 30), 2.0 + 0.4 * (i / 30), 5},
                .linearVelocity = {3, -150, 40},
                .shape = shapes[i % 2]});
    zoo_.world.addImpulse(loose_[7], {2, 3, 0});
  }

  void remove() {
    for (size_t i = 0; i < loose_.size(); i += 5) zoo_.world.destroy(loose_[i]);
    zoo_.world.destroy(zoo_.joints[3]);
  }

  /// What const functions compute for the first asker, many ask at once.
  void lookAround() const {
    const World& world = zoo_.world;
    std::vector<std::thread> readers;
    for (int i = 0; i < 3; ++i)
      readers.emplace_back([&world] {
        world.rayClosest({.origin = {5, 9, 7}, .direction = {0, -1, 0}, .length = 20});
        world.hash(), world.contacts(), world.snapshotSize();
        std::vector<std::byte> bytes;
        world.save(bytes);
      });
    for (std::thread& reader : readers) reader.join();
  }

  SnapshotZoo zoo_;
  std::vector<BodyId> loose_;
  SoftId folded_{};
  bool asleep_ = false, touchedItself_ = false;
  uint64_t impacts_ = 0;
};

WorldDef settings() { return {.substeps = 2, .moveEvents = true, .sleepTime = 0.05f}; }

TEST(WorkersZoo, ManyDoAsOneDoes) {
  Crowd alone(settings());
  const std::vector<uint64_t> expected = alone.live(17);
  EXPECT_TRUE(alone.slept());
  EXPECT_GT(alone.impacts(), 20u);
  EXPECT_TRUE(alone.touchedItself());
  for (const int workers : {2, 5}) {
    WorldDef def = settings();
    def.workers = workers;
    EXPECT_EQ(Crowd(def).live(17), expected) << workers << " workers";
  }
}

TEST(WorkersZoo, ManyDoAsOneDoesInTheBlockSweep) {
  WorldDef def = settings();
  def.primalSolver = PrimalSolver::BlockSweep;
  const std::vector<uint64_t> expected = Crowd(def).live(12);
  def.workers = 4;
  EXPECT_EQ(Crowd(def).live(12), expected);
}

TEST(WorkersZoo, WorldsOfManyThreadsShareNothing) {
  const std::vector<uint64_t> expected = Crowd(settings()).live(4);
  std::vector<std::vector<uint64_t>> found(3);
  std::vector<std::thread> threads;
  for (size_t i = 0; i < found.size(); ++i)
    threads.emplace_back([&mine = found[i]] {
      WorldDef def = settings();
      def.workers = 2;
      mine = Crowd(def).live(4);
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<uint64_t>& mine : found) EXPECT_EQ(mine, expected);
}

}  // namespace
}  // namespace avbd
