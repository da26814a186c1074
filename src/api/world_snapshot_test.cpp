// A snapshot holds all that the future depends on, and nothing but a sound one is taken.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <ostream>
#include <random>

#include "api/snapshot_zoo.h"
#include "base/hash.h"

namespace avbd {
namespace {

using Bytes = std::vector<std::byte>;

/// What a step shows to the user.
struct Shown {
  uint64_t hash = 0;
  std::array<uint64_t, kStageCount> stages{};
  double time = 0;
  uint64_t step = 0;
  size_t events = 0;
  Vec3d contacts;  ///< sum of places and forces
  double joints = 0;
  friend bool operator==(const Shown&, const Shown&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Shown& s) { return out << s.step << ':' << s.hash << '\n'; }
};

Shown shown(const World& world) {
  const Events& e = world.events();
  Shown s;
  s.hash = world.hash(), s.stages = world.stageHashes();
  s.time = world.time(), s.step = world.report().step;
  s.events = e.begins.size() + 7 * e.ends.size() + 49 * e.enters.size() + 343 * e.leaves.size() + 2401 * e.hits.size() +
             16807 * e.breaks.size() + 117649 * e.moves.size();
  for (const Contact& contact : world.contacts())
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& p = contact.points[static_cast<size_t>(i)];
      s.contacts = s.contacts + p.position * (1.0 + static_cast<double>(contact.touch)) + p.frictionForce +
                   Vec3d{p.separation, p.normalForce, static_cast<double>(p.feature % 1000)};
    }
  for (const JointId joint : world.joints()) {
    s.joints += world.gap(joint) + static_cast<double>(length(world.reaction(joint).force));
    if (world.type(joint) == JointType::Hinge) s.joints += world.coordinate(joint).position;
    if (world.type(joint) == JointType::Custom) s.joints += static_cast<double>(world.customJoint(joint).memory[0]);
  }
  return s;
}

std::vector<Shown> run(World& world, int steps) {
  std::vector<Shown> all{shown(world)};
  for (int i = 0; i < steps; ++i) world.step(1.0f / 60), all.push_back(shown(world));
  return all;
}

Bytes saved(const World& world) {
  Bytes bytes;
  world.save(bytes);
  return bytes;
}

TEST(Snapshot, TheWorldGoesOnFromItAsItDid) {
  SnapshotZoo zoo;
  for (const int before : {0, 1, 7, 60}) {
    zoo.step(before);
    const Bytes bytes = saved(zoo.world);
    const std::vector<Shown> first = run(zoo.world, 25);
    zoo.world.restore(bytes);
    EXPECT_EQ(run(zoo.world, 25), first) << before;
    EXPECT_NE(zoo.world.hash(), first[0].hash) << "nothing happened";
  }
}

TEST(Snapshot, ANewWorldOfTheSameMakingBecomesACopy) {
  SnapshotZoo zoo;
  zoo.step(50);
  const Bytes bytes = saved(zoo.world);
  SnapshotZoo other;
  other.world.restore(bytes);
  EXPECT_EQ(saved(other.world), bytes) << "something was lost on the way";
  EXPECT_EQ(run(other.world, 40), run(zoo.world, 40));
}

TEST(Snapshot, WorkersAndWidthAreTheWorldsOwn) {
  SnapshotZoo zoo;
  zoo.step(30);
  WorldDef narrow = SnapshotZoo::usual();
  narrow.simdWidth = 1, narrow.workers = 2, narrow.gravity = {1, 0, 0}, narrow.iterations = 9, narrow.substeps = 1;
  SnapshotZoo other(narrow);
  other.world.restore(saved(zoo.world));
  EXPECT_EQ(other.world.definition().simdWidth, 1);
  EXPECT_EQ(other.world.definition().workers, 2);
  EXPECT_EQ(other.world.definition().gravity, (Vec3{0, -9.81f, 0}));
  EXPECT_EQ(other.world.definition().iterations, 4);
  EXPECT_EQ(run(other.world, 20), run(zoo.world, 20));
}

TEST(Snapshot, IdsComeBackWithWhatTheyNamed) {
  SnapshotZoo zoo;
  zoo.step(20);
  const Bytes bytes = saved(zoo.world);
  const BodyId next = zoo.add({.position = {0, 20, 0}, .shape = Box{}});
  const std::vector<Shown> first = run(zoo.world, 15);

  zoo.world.restore(bytes);
  EXPECT_FALSE(zoo.world.isAlive(next));
  // Quite another future: much dies, and others take the slots.
  for (const size_t i : {2u, 4u, 13u, 16u, 20u}) zoo.world.destroy(zoo.bodies[i]);
  zoo.world.destroy(zoo.joints[7]);
  zoo.step(2);
  for (int i = 0; i < 9; ++i) zoo.add({.position = {0.1 * i, 4.0 + i, 1}, .shape = Sphere{0.3f}});
  zoo.world.setGravity({0, 3, 0});
  zoo.world.setFilter(zoo.world.shapes(zoo.bodies[1])[0], {.mask = 0});
  zoo.step(5);

  zoo.world.restore(bytes);
  for (size_t i = 0; i < 20; ++i) EXPECT_TRUE(zoo.world.isAlive(zoo.bodies[i])) << i;
  EXPECT_EQ(zoo.world.create(BodyDef{.position = {0, 20, 0}, .shape = Box{}}), next) << "ids go on as they did";
  EXPECT_EQ(run(zoo.world, 15), first);
}

TEST(Snapshot, BetweenStepsAllThatIsPendingIsInIt) {
  SnapshotZoo zoo;
  zoo.step(25);
  // Forgotten pairs, unpaired shapes, forces given, lost touches, free slots.
  zoo.world.setPose(zoo.bodies[3], {{0.2, 0.9, 0.1}, {}});
  zoo.world.destroy(zoo.bodies[5]);
  zoo.world.create(BodyDef{.position = {0, 9, 0}, .shape = Sphere{0.2f}});
  zoo.world.addForce(zoo.bodies[1], {0, 0, 500});
  zoo.world.addJointForce(zoo.joints[1], 4);
  zoo.world.setHitEvents(zoo.world.shapes(zoo.bodies[2])[0], false);
  const Bytes bytes = saved(zoo.world);
  const std::vector<Shown> first = run(zoo.world, 10);
  zoo.world.restore(bytes);
  EXPECT_EQ(saved(zoo.world), bytes);
  EXPECT_EQ(run(zoo.world, 10), first);
}

TEST(Snapshot, QueriesAfterItFindWhatTheyFound) {
  SnapshotZoo zoo;
  zoo.step(30);
  const Bytes bytes = saved(zoo.world);
  const auto ask = [&] { return zoo.world.rayAll({.origin = {0.1, 10, 0.1}, .direction = {0, -1, 0}, .length = 20}); };
  const std::vector<CastHit> before = ask();
  ASSERT_GT(before.size(), 1u);
  zoo.step(9);
  ask();
  zoo.world.restore(bytes);
  const std::vector<CastHit> after = ask();
  ASSERT_EQ(after.size(), before.size());
  for (size_t i = 0; i < after.size(); ++i) EXPECT_EQ(after[i].shape, before[i].shape);
}

TEST(Snapshot, MemoryIsTheCallers) {
  SnapshotZoo zoo;
  zoo.step(5);
  const Bytes bytes = saved(zoo.world);
  EXPECT_EQ(zoo.world.snapshotSize(), bytes.size());
  Bytes large(bytes.size() + 1000);
  EXPECT_EQ(zoo.world.save(std::span(large)), bytes.size());
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), large.begin()));
  for (size_t more = 0; more < 1000; more += more < 20 ? 1 : 97) {
    std::fill(large.begin(), large.end(), std::byte{77});
    EXPECT_EQ(zoo.world.save(std::span(large).first(bytes.size() + more)), bytes.size());
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), large.begin())) << more;
    EXPECT_EQ(large[bytes.size()], std::byte{77});
  }
  for (const size_t size : {size_t{0}, size_t{39}, bytes.size() / 2, bytes.size() - 1}) {
    Bytes small(size);
    try {
      zoo.world.save(std::span(small));
      ADD_FAILURE() << "it does not fit";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(std::to_string(bytes.size())), std::string::npos) << e.what();
    }
  }
  const std::byte* const place = large.data();
  zoo.world.save(large);
  EXPECT_EQ(large.data(), place) << "there was room";
  EXPECT_EQ(large, bytes);
}

TEST(Snapshot, OfAnyLengthIsCountedWhereItDoesNotFit) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  for (int i = 0; i < 400; ++i)
    world.create(BodyDef{.position = {1.0 * (i % 20), 0.45, 1.0 * (i / 20)}, .shape = Sphere{0.5f}});
  for (int i = 0; i < 3; ++i) world.step(1.0f / 60);
  const Bytes bytes = saved(world);
  EXPECT_EQ(world.snapshotSize(), bytes.size());
  Bytes place(bytes.size() + 8192);
  for (const size_t missing : {size_t{1}, size_t{5000}, bytes.size() / 2, bytes.size() - 40}) {
    std::fill(place.begin(), place.end(), std::byte{77});
    const size_t length = bytes.size() - missing;
    EXPECT_THROW(world.save(std::span(place).first(length)), Error) << missing;
    EXPECT_TRUE(std::all_of(place.begin() + static_cast<ptrdiff_t>(length), place.end(),
                            [](std::byte b) { return b == std::byte{77}; }));
  }
}

/// Expects a refusal that says `word`, and a world that is what it was.
void expectRefused(World& world, std::span<const std::byte> bytes, const std::string& word) {
  const uint64_t hash = world.hash();
  const Bytes before = saved(world);
  try {
    world.restore(bytes);
    ADD_FAILURE() << "accepted: " << word;
  } catch (const Error& e) {
    EXPECT_EQ(e.definition(), "World::restore");
    EXPECT_EQ(e.field(), "snapshot");
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
  EXPECT_EQ(world.hash(), hash);
  EXPECT_EQ(saved(world), before);
}

/// The hash of the bytes as they are now.
void seal(Bytes& bytes) {
  Hash64 hash;
  hash.bytes(bytes.data(), 32);
  hash.bytes(bytes.data() + 40, bytes.size() - 40);
  const uint64_t digest = hash.digest();
  std::memcpy(bytes.data() + 32, &digest, sizeof(digest));
}

TEST(Snapshot, WhatIsNoneIsRefusedByName) {
  SnapshotZoo zoo;
  zoo.step(12);
  const Bytes good = saved(zoo.world);
  zoo.step(3);
  expectRefused(zoo.world, {}, "empty");
  expectRefused(zoo.world, std::span(good).first(17), "cut short");
  expectRefused(zoo.world, std::span(good).first(good.size() - 1), "cut short");
  Bytes bytes = good;
  bytes.push_back({});
  expectRefused(zoo.world, bytes, "as long as it was saved");
  bytes = good;
  bytes[0] = std::byte{'B'};
  expectRefused(zoo.world, bytes, "no snapshot");
  bytes = good;
  bytes[8] = std::byte{4};
  expectRefused(zoo.world, bytes, "version 4: must be version 5");
  bytes[8] = std::byte{6};
  expectRefused(zoo.world, bytes, "version 6: must be version 5");
  zoo.world.restore(good);
}

TEST(Snapshot, AFlippedBitIsRefused) {
  SnapshotZoo zoo;
  zoo.step(12);
  const Bytes good = saved(zoo.world);
  const uint64_t hash = zoo.world.hash();
  for (size_t at = 0; at < good.size(); at += at < 64 ? 1 : 211) {
    Bytes bytes = good;
    bytes[at] ^= std::byte{static_cast<uint8_t>(1 << at % 8)};
    EXPECT_THROW(zoo.world.restore(bytes), Error) << at;
  }
  EXPECT_EQ(zoo.world.hash(), hash);
}

TEST(Snapshot, AnotherWorldIsRefusedByName) {
  SnapshotZoo zoo;
  zoo.step(12);
  const Bytes good = saved(zoo.world);
  World plain(SnapshotZoo::usual());
  expectRefused(plain, good, "must name a Hull that this world has or had");
  WorldDef coarse = SnapshotZoo::usual();
  coarse.lengthUnit = 2;
  World other(coarse);
  expectRefused(other, good, "equal WorldDef");
  SnapshotZoo unhooked(SnapshotZoo::usual(), false);
  expectRefused(unhooked.world, good, "contact hook");
  expectRefused(zoo.world, saved(unhooked.world), "without contact hook");
}

TEST(Snapshot, WhatIsSharedStaysAsLongAsASnapshotMayNameIt) {
  World world;
  const std::vector<Vec3> corners = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  const BodyId rock = world.create(BodyDef{.shape = Hull{makeHull({.points = corners}), {1, 2, 1}}});
  const Bytes bytes = saved(world);
  world.destroy(rock);
  for (int i = 0; i < 3; ++i) world.step(1.0f / 60);
  world.restore(bytes);
  EXPECT_EQ(std::get<Hull>(world.geometry(world.shapes(rock)[0])).data->vertices().size(), corners.size());
  world.step(1.0f / 60);
}

TEST(Snapshot, ACustomJointOfMoreBodiesThanThereArePlacesIsRefused) {
  World world;
  const BodyId body = world.create(BodyDef{.shape = Sphere{}});
  const float mark = 12345.5f;
  world.create(CustomJoint{
      .family = std::make_shared<CountingRod>(), .bodies = {BodyId{}, body}, .constants = {mark}, .memory = {0}});
  const Bytes good = saved(world);
  const auto* name = reinterpret_cast<const std::byte*>(&mark);
  const size_t at =
      static_cast<size_t>(std::search(good.begin(), good.end(), name, name + sizeof(mark)) - good.begin());
  ASSERT_LT(at, good.size());
  // Before the constants stands how many they are, and before that how many bodies.
  for (const int32_t bodies : {2, 0, 5, -1}) {
    Bytes bytes = good;
    std::memcpy(bytes.data() + at - 5, &bodies, sizeof(bodies));
    seal(bytes);
    if (bodies == 2)
      EXPECT_EQ(bytes, good);
    else
      expectRefused(world, bytes, "too few or too many bodies");
  }
}

TEST(Snapshot, HostileContentUnderARightHashHarmsNothing) {
  SnapshotZoo zoo;
  zoo.step(12);
  const Bytes good = saved(zoo.world);
  std::mt19937 random(5);
  int refused = 0, taken = 0;
  for (int i = 0; i < 400; ++i) {
    Bytes bytes = good;
    for (uint32_t k = 0; k <= random() % 3; ++k) {
      const size_t at = 40 + random() % (bytes.size() - 40);
      bytes[at] = std::byte{static_cast<uint8_t>(random())};
    }
    if (i % 10 == 0) bytes.resize(40 + random() % (bytes.size() - 40));
    const uint64_t size = bytes.size();
    std::memcpy(bytes.data() + 16, &size, sizeof(size));
    seal(bytes);
    try {
      zoo.world.restore(bytes);
      ++taken;
      zoo.world.hash(), zoo.world.contacts();
      if (i % 4 == 0) zoo.step(2);
    } catch (const Error&) {
      ++refused;
    } catch (const NonFiniteError&) {
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(taken, 20);
  zoo.world.restore(good);
}

}  // namespace
}  // namespace avbd
