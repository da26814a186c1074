// Same bits: at every lane width, in every run, whatever else is in the world, and at every scale of two.
#include <avbd/avbd.h>
#include <avbd/mesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "solve/backend.h"

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

BodyId addGround(World& world) { return world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}}); }
Geometry shapeOf(int i) {
  if (i % 3 == 0) return Box{0.3f, 0.2f, 0.25f};
  if (i % 3 == 1) return Sphere{0.25f};
  return Capsule{0.2f, 0.2f};
}

// ---- Scenes, each at a place of its own ------------------------------------------------------------------------

using Scene = std::function<std::vector<BodyId>(World&, BodyId, Vec3d)>;

std::vector<BodyId> addPile(World& world, BodyId, Vec3d at) {
  std::vector<BodyId> ids;
  for (int i = 0; i < 24; ++i)
    ids.push_back(world.create(BodyDef{.position = at + Vec3d{0.31 * (i % 3), 0.4 + 0.45 * (i / 3), 0.29 * (i % 2)},
                                       .rotation = {0.8f, 0.6f * (i % 2), 0, 0.6f * ((i + 1) % 2)},
                                       .shape = shapeOf(i)}));
  return ids;
}

std::vector<BodyId> addChain(World& world, BodyId ground, Vec3d at) {
  std::vector<BodyId> ids;
  for (int i = 0; i < 10; ++i) {
    ids.push_back(world.create(
        BodyDef{.position = at + Vec3d{0.5 + i, 4, 0}, .shape = Capsule{0.1f, 0.4f}, .mass = i == 9 ? 200.0f : 1.0f}));
    const Pose before = i ? Pose{{0.5, 0, 0}, {}} : Pose{at + Vec3d{0, 4, 0}, {}};
    const BodyId other = i ? ids[ids.size() - 2] : ground;
    world.create(BallJoint{.bodyA = other, .bodyB = ids.back(), .frameA = before, .frameB = {{-0.5, 0, 0}, {}}});
  }
  return ids;
}

/// Tied bodies with a loop, on the ground: tree, loop-closing joint and contacts in one island.
std::vector<BodyId> addFrame(World& world, BodyId, Vec3d at) {
  std::vector<BodyId> ids;
  const Vec3d corner[4] = {{0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  for (const Vec3d& c : corner)
    ids.push_back(world.create(BodyDef{.position = at + c, .shape = Box{0.3f, 0.3f, 0.3f}, .density = 300}));
  for (size_t i = 0; i < 4; ++i) {
    const size_t next = (i + 1) % 4;
    const Vec3d half = (corner[next] - corner[i]) * 0.5;
    if (i % 2)
      world.create(FixedJoint{.bodyA = ids[i], .bodyB = ids[next], .frameA = {half, {}}, .frameB = {half * -1, {}}});
    else
      world.create(BallJoint{.bodyA = ids[i], .bodyB = ids[next], .frameA = {half, {}}, .frameB = {half * -1, {}}});
  }
  return ids;
}

std::vector<BodyId> addConveyor(World& world, BodyId, Vec3d at) {
  const BodyId belt = world.create(BodyDef{.type = BodyType::Kinematic,
                                           .position = at + Vec3d{0, 0.2, 0},
                                           .linearVelocity = {0.7f, 0, 0},
                                           .angularVelocity = {0, 0.3f, 0},
                                           .shape = Box{3, 0.2f, 3}});
  std::vector<BodyId> ids{belt};
  for (int i = 0; i < 6; ++i)
    ids.push_back(world.create(BodyDef{.position = at + Vec3d{0.1 * i, 0.8 + 0.5 * i, 0.2}, .shape = shapeOf(i)}));
  const BodyId hung = world.create(BodyDef{.position = at + Vec3d{2, 1.4, 0}, .shape = Sphere{0.2f}});
  world.create(BallJoint{.bodyA = belt, .bodyB = hung, .frameA = {{2, 0.7, 0}, {}}, .frameB = {{0, -0.5, 0}, {}}});
  ids.push_back(hung);
  return ids;
}

std::vector<BodyId> addSoft(World& world, BodyId, Vec3d at) {
  std::vector<BodyId> ids;
  const Vec3d corner[5] = {{0, 1, 0}, {1, 1, 0}, {0.5, 1, 0.9}, {0.5, 1.8, 0.3}, {0.5, 0.3, 0.3}};
  for (const Vec3d& c : corner)
    ids.push_back(world.create(BodyDef{.position = at + c, .shape = Sphere{0.1f}, .locks = kLockAngular}));
  world.create(TetVolume{.bodies = {ids[0], ids[1], ids[2], ids[3]}});
  world.create(TetVolume{.bodies = {ids[0], ids[1], ids[2], ids[4]}, .stiffness = 1e6f});
  return ids;
}

std::vector<BodyId> addLocked(World& world, BodyId, Vec3d at) {
  std::vector<BodyId> ids;
  for (int i = 0; i < 5; ++i)
    ids.push_back(world.create(BodyDef{.position = at + Vec3d{0.05 * i, 0.3 + 0.62 * i, 0},
                                       .angularVelocity = {1, 0.5f, 0.2f},
                                       .shape = Box{0.3f, 0.3f, 0.3f},
                                       .linearDamping = 0.1f,
                                       .locks = static_cast<uint8_t>(i == 2 ? kLockAngular : 1 << (i + 1))}));
  return ids;
}

/// Bodies tumble over a rough mesh, one of them turns it; a trigger watches.
std::vector<BodyId> addTerrain(World& world, BodyId, Vec3d at) {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  constexpr uint32_t kSide = 9;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const uint32_t x = i % kSide, z = i / kSide;
    vertices.push_back({0.5f * static_cast<float>(x) - 2, 0.07f * static_cast<float>((3 * x + 5 * z) % 7),
                        0.5f * static_cast<float>(z) - 2});
    if (x + 1 == kSide || z + 1 == kSide) continue;
    triangles.push_back({i, i + kSide, i + kSide + 1});
    triangles.push_back({i, i + kSide + 1, i + 1});
  }
  BodyDef terrain{.type = BodyType::Kinematic, .position = at + Vec3d{0, 1, 0}, .angularVelocity = {0, 0.2f, 0}};
  terrain.shapes.push_back({.geometry = Mesh{makeMesh({.vertices = vertices, .triangles = triangles})}});
  terrain.shapes.push_back({.geometry = Sphere{1}, .pose = {{0, 1, 0}, {}}, .isTrigger = true});
  std::vector<BodyId> ids{world.create(terrain)};
  for (int i = 0; i < 10; ++i)
    ids.push_back(world.create(BodyDef{.position = at + Vec3d{0.4 * (i % 4) - 0.6, 1.8 + 0.4 * (i / 4), 0.4 * (i % 3)},
                                       .rotation = {0.8f, 0, 0.6f, 0},
                                       .shape = shapeOf(i)}));
  return ids;
}

/// Torsional and rolling friction, among bodies and on the ground.
std::vector<BodyId> addRolling(World& world, BodyId, Vec3d at) {
  std::vector<BodyId> ids;
  const Material own{.frictionPriority = 1, .rollingFriction = 0.01f};
  for (int i = 0; i < 10; ++i) {
    Material material = own;
    material.torsionalFriction = i % 2 ? 0.02f : 0.0f;
    ids.push_back(world.create(BodyDef{.position = at + Vec3d{0.3 * (i % 3), 0.4 + 0.5 * (i / 3), 0.2 * (i % 2)},
                                       .linearVelocity = {1, 0, 0.5f},
                                       .angularVelocity = {0, 5, 1},
                                       .shape = shapeOf(i),
                                       .material = i % 4 == 3 ? Material{} : material}));
  }
  return ids;
}

/// A hook with belts, scaled masses and refusals, which looks at nothing but the plan.
std::vector<BodyId> addHooked(World& world, BodyId, Vec3d at) {
  world.setContactHook([](ContactPlan& plan) {
    plan.surfaceVelocity = plan.pointCount > 2 ? Vec3{0.5f, 0, 0.2f} : Vec3{};
    plan.inverseMassScaleB = plan.pointCount > 2 ? 0.5f : 1.0f;
    plan.rollingFriction = 0.01f;
    return plan.separations[0] > -0.3f;
  });
  std::vector<BodyId> ids;
  for (int i = 0; i < 12; ++i) {
    BodyDef def{.position = at + Vec3d{0.31 * (i % 3), 0.4 + 0.45 * (i / 3), 0.29 * (i % 2)}};
    def.shapes.push_back({.geometry = shapeOf(i), .contactHook = i % 3 != 2});
    ids.push_back(world.create(def));
  }
  return ids;
}

const std::pair<const char*, Scene> kScenes[] = {
    {"pile", addPile},         {"chain", addChain},     {"frame", addFrame},
    {"conveyor", addConveyor}, {"soft", addSoft},       {"locked", addLocked},
    {"terrain", addTerrain},   {"rolling", addRolling}, {"hooked", addHooked}};

uint64_t hashAfter(const Scene& scene, WorldDef def, int steps) {
  def.sleep = false;
  World world(def);
  const BodyId ground = addGround(world);
  scene(world, ground, {});
  for (int i = 0; i < steps; ++i) world.step(kDt);
  for (const BodyId id : world.bodies()) EXPECT_TRUE(std::isfinite(length(world.pose(id).position)));
  return world.hash();
}

TEST(SameBits, EveryWidthAndEveryRun) {
  for (const auto& [name, scene] : kScenes) {
    const uint64_t hash = hashAfter(scene, {.simdWidth = 1}, 150);
    EXPECT_EQ(hashAfter(scene, {.simdWidth = 1}, 150), hash) << name << ", another run";
    for (const int width : {4, 8, 16}) {
      if (!laneWidthRuns(width)) continue;
      EXPECT_EQ(hashAfter(scene, {.simdWidth = width}, 150), hash) << name << ", width " << width;
    }
    EXPECT_NE(hashAfter(scene, {.simdWidth = 1}, 149), hash) << name << ": the hash sees nothing";
  }
}

TEST(SameBits, BlockSweepToo) {
  for (const auto& [name, scene] : kScenes) {
    const uint64_t hash = hashAfter(scene, {.primalSolver = PrimalSolver::BlockSweep, .simdWidth = 1}, 60);
    for (const int width : {4, 8, 16}) {
      if (!laneWidthRuns(width)) continue;
      EXPECT_EQ(hashAfter(scene, {.primalSolver = PrimalSolver::BlockSweep, .simdWidth = width}, 60), hash)
          << name << ", width " << width;
    }
  }
}

TEST(SameBits, SubstepsToo) {
  for (const auto& [name, scene] : kScenes) {
    const uint64_t hash = hashAfter(scene, {.iterations = 2, .substeps = 3, .simdWidth = 4}, 40);
    EXPECT_EQ(hashAfter(scene, {.iterations = 2, .substeps = 3, .simdWidth = 1}, 40), hash) << name;
  }
}

/// Bodies, shapes and joints come and go while the world runs.
uint64_t hashOfChurn(int width) {
  World world({.simdWidth = width});
  const BodyId ground = addGround(world);
  std::vector<BodyId> ids = addPile(world, ground, {});
  uint32_t random = 1;
  const auto pick = [&] { return (random = random * 1664525u + 1013904223u) >> 8; };
  for (int i = 0; i < 150; ++i) {
    world.step(kDt);
    const size_t at = pick() % ids.size(), other = pick() % ids.size();
    if (i % 5 == 0) {
      world.destroy(ids[at]);
      ids[at] = world.create(BodyDef{.position = {0.2, 5, 0.1 * (i % 7)}, .shape = shapeOf(i)});
    } else if (i % 5 == 1 && at != other) {
      const Vec3d half = rotate(conjugate(world.pose(ids[at]).rotation),
                                (world.pose(ids[other]).position - world.pose(ids[at]).position));
      world.create(BallJoint{.bodyA = ids[at], .bodyB = ids[other], .frameA = {half, {}}});
    } else if (i % 5 == 2 && world.jointCount() > 2) {
      world.destroy(world.joints()[pick() % world.jointCount()]);
    } else if (i % 5 == 3) {
      world.create(ids[at], {.geometry = Sphere{0.15f}, .pose = {{0.2, 0.1, 0}, {}}});
    } else if (world.shapes(ids[at]).size() > 1) {
      world.destroy(world.shapes(ids[at])[1]);
    }
  }
  for (const BodyId id : world.bodies()) EXPECT_LT(length(world.pose(id).position), 100);
  return world.hash();
}

TEST(SameBits, WhileThingsComeAndGo) {
  const uint64_t hash = hashOfChurn(1);
  EXPECT_EQ(hashOfChurn(1), hash);
  for (const int width : {4, 8, 16})
    if (laneWidthRuns(width)) {
      EXPECT_EQ(hashOfChurn(width), hash) << width;
    }
}

// ---- Unrelated islands -----------------------------------------------------------------------------------------

void addAll(World& world, BodyId ground, Vec3d at) {
  for (const auto& entry : kScenes) {
    entry.second(world, ground, at);
    at = at + Vec3d{0, 0, 100};
  }
}

/// Poses and velocities of some bodies, step by step.
std::vector<std::pair<Pose, Velocity>> trace(World& world, const std::vector<BodyId>& ids, int steps) {
  std::vector<std::pair<Pose, Velocity>> out;
  for (int i = 0; i < steps; ++i) {
    world.step(kDt);
    for (const BodyId id : ids) out.push_back({world.pose(id), world.velocity(id)});
  }
  return out;
}

void expectUntouched(const char* name, const Scene& scene, PrimalSolver solver) {
  const WorldDef def{.primalSolver = solver};
  World alone(def), before(def), after(def);
  const BodyId ground[] = {addGround(alone), addGround(before), addGround(after)};
  const auto idsAlone = scene(alone, ground[0], {});
  addAll(before, ground[1], {500, 0, 0});
  const auto idsBefore = scene(before, ground[1], {});
  const auto idsAfter = scene(after, ground[2], {});
  addAll(after, ground[2], {500, 0, 0});
  const auto expected = trace(alone, idsAlone, 120);
  EXPECT_TRUE(trace(before, idsBefore, 120) == expected) << name << ", made after the others";
  EXPECT_TRUE(trace(after, idsAfter, 120) == expected) << name << ", made before the others";
}

TEST(SameBits, NothingFarAwayChangesABit) {
  for (const auto& [name, scene] : kScenes)
    for (const PrimalSolver solver : {PrimalSolver::Krylov, PrimalSolver::BlockSweep})
      expectUntouched(name, scene, solver);
}

TEST(SameBits, WhatComesAndGoesFarAwayChangesNothing) {
  for (const auto& [name, scene] : kScenes) {
    World alone, visited;
    const BodyId ground[] = {addGround(alone), addGround(visited)};
    const auto ids = scene(alone, ground[0], {}), visitedIds = scene(visited, ground[1], {});
    for (int round = 0; round < 4; ++round) {
      std::vector<BodyId> guests = addPile(visited, ground[1], {500, 0, 0});
      const auto expected = trace(alone, ids, 20);
      ASSERT_TRUE(trace(visited, visitedIds, 20) == expected) << name << " with guests, round " << round;
      for (const BodyId id : guests) visited.destroy(id);
      const auto later = trace(alone, ids, 5);
      ASSERT_TRUE(trace(visited, visitedIds, 5) == later) << name << " after the guests, round " << round;
    }
  }
}

// ---- Scale -----------------------------------------------------------------------------------------------------

// Powers of two round alike: with all masses 2^k larger the motion is the same to the bit, and forces are 2^k larger.
TEST(Scale, MassesTimesAPowerOfTwoMoveAlike) {
  for (const float by : {1024.0f, 1 / 1024.0f}) {
    World one, scaled;
    std::vector<BodyId> ids, scaledIds;
    for (World* world : {&one, &scaled}) {
      const float density = world == &one ? 1000 : 1000 * by;
      addGround(*world);
      auto& list = world == &one ? ids : scaledIds;
      for (int i = 0; i < 20; ++i)
        list.push_back(world->create(BodyDef{.position = {0.31 * (i % 3), 0.4 + 0.45 * (i / 3), 0.29 * (i % 2)},
                                             .shape = shapeOf(i),
                                             .density = density}));
      for (size_t i = 0; i + 1 < 6; ++i)
        world->create(BallJoint{
            .bodyA = list[i], .bodyB = list[i + 1], .frameA = {{0.2, 0.2, 0}, {}}, .frameB = {{-0.1, -0.2, 0}, {}}});
    }
    for (int i = 0; i < 120; ++i) {
      one.step(kDt);
      scaled.step(kDt);
      for (size_t k = 0; k < ids.size(); ++k) ASSERT_EQ(one.pose(ids[k]), scaled.pose(scaledIds[k])) << i << " " << by;
    }
    const auto a = one.contacts(), b = scaled.contacts();
    ASSERT_EQ(a.size(), b.size());
    ASSERT_GT(a.size(), 10u);
    for (size_t i = 0; i < a.size(); ++i)
      for (int k = 0; k < a[i].pointCount; ++k) {
        const ContactPoint &p = a[i].points[static_cast<size_t>(k)], &q = b[i].points[static_cast<size_t>(k)];
        EXPECT_EQ(q.normalForce, by * p.normalForce);
        EXPECT_EQ(q.frictionForce, p.frictionForce * by);
      }
    for (size_t i = 0; i < one.jointCount(); ++i)
      EXPECT_EQ(scaled.reaction(scaled.joints()[i]).force, one.reaction(one.joints()[i]).force * by);
  }
}

/// The same scene in units of which `unit` make a metre; times and masses as they are.
std::vector<Vec3d> positionsInUnits(float unit, int steps) {
  World world({.gravity = {0, -9.81f * unit, 0},
               .lengthUnit = unit,
               .restitutionThreshold = unit,
               .maxDepenetrationSpeed = 3 * unit});
  addGround(world);
  std::vector<BodyId> ids;
  for (int i = 0; i < 16; ++i) {
    Geometry shape = shapeOf(i);
    if (auto* box = std::get_if<Box>(&shape)) *box = {box->x * unit, box->y * unit, box->z * unit};
    if (auto* ball = std::get_if<Sphere>(&shape)) ball->radius *= unit;
    if (auto* capsule = std::get_if<Capsule>(&shape)) *capsule = {capsule->radius * unit, capsule->halfHeight * unit};
    ids.push_back(
        world.create(BodyDef{.position = Vec3d{0.31 * (i % 3), 0.4 + 0.45 * (i / 3), 0.29 * (i % 2)} * double(unit),
                             .shape = shape,
                             .mass = 1 + static_cast<float>(i % 4),
                             .maxLinearSpeed = 1e4f * unit}));
  }
  world.create(BallJoint{.bodyA = ids[0],
                         .bodyB = ids[3],
                         .frameA = {Vec3d{0, 0.2, 0} * double(unit), {}},
                         .frameB = {Vec3d{0, -0.25, 0} * double(unit), {}}});
  for (int i = 0; i < steps; ++i) world.step(kDt);
  std::vector<Vec3d> out;
  for (const BodyId id : ids) out.push_back(world.pose(id).position * (1 / double(unit)));
  return out;
}

TEST(Scale, LengthUnitIsANameForTheMetre) {
  const std::vector<Vec3d> metres = positionsInUnits(1, 60);
  for (const float unit : {1024.0f, 1 / 32.0f}) {
    const std::vector<Vec3d> other = positionsInUnits(unit, 60);
    for (size_t i = 0; i < metres.size(); ++i) EXPECT_EQ(other[i], metres[i]) << "unit " << unit << " body " << i;
  }
}

}  // namespace
}  // namespace avbd
