// Acceptance, state: the same bits, islands that do not know of each other, creating and destroying in a run.
#include <avbd/mesh.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "scenes/allocations.h"
#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

uint64_t hashAfter(const Scene& scene, const Settings& settings, int steps) {
  Model model = scene.make(settings);
  for (int i = 0; i < steps; ++i) model.world.step(static_cast<float>(model.dt));
  return model.world.hash();
}

// A width that this processor does not run is refused by the world; the others are compared.
Figure oneHash(const Scene& scene, Settings settings) {
  constexpr size_t kLarge = 1000;
  const size_t bodies = scene.make(settings).bodies.size();
  const int steps = bodies > kLarge ? 10 : 60;
  std::set<uint64_t> hashes;
  int runs = 0;
  for (const int width : {1, 4, 8, 16})
    for (const int workers : {1, 2, 5, 8}) {
      if (bodies > kLarge && workers != 1 && workers != 5) continue;
      settings.simdWidth = width;
      settings.workers = workers;
      try {
        hashes.insert(hashAfter(scene, settings, steps));
        ++runs;
      } catch (const Error&) {
      }
    }
  const double found = runs > 1 ? static_cast<double>(hashes.size()) : NAN;
  return {"hashes", "scene=" + scene.name + " runs=" + std::to_string(runs), found, 1, 1, "hashes"};
}

std::vector<Figure> sameBits(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Scene& scene : all())
    if (scene.name != "sleepers") figures.push_back(oneHash(scene, settings));  // those would be made sixteen times
  return figures;
}

void addFarIsland(Model& model, const Settings& settings) {
  (void)settings;
  BodyDef def;
  def.type = BodyType::Static;
  def.position = {1000, -1, 0};
  def.shape = Box{10, 1, 10};
  model.world.create(def);
  def.type = BodyType::Dynamic;
  def.shape = Box{0.5f, 0.5f, 0.5f};
  for (int i = 0; i < 5; ++i) {
    def.position = {1000 + 0.2 * i, 0.6 + 1.1 * i, 0};
    model.world.create(def);
  }
  BallJoint joint;
  def.position = {1005, 3, 0};
  joint.bodyB = model.world.create(def);
  joint.frameA.position = {1006, 4, 0};
  joint.frameB.position = {1, 1, 0};
  model.world.create(joint);
}

std::vector<Figure> unrelated(const Settings& settings) {
  std::vector<Figure> figures;
  for (const char* name : {"tower10", "chain", "card_house", "net"}) {
    const Scene& scene = *find(name);
    Model plain = scene.make(settings), with = scene.make(settings);
    addFarIsland(with, settings);
    int apart = 0;
    for (int i = 0; i < 120 && apart == 0; ++i) {
      plain.world.step(static_cast<float>(kDt));
      with.world.step(static_cast<float>(kDt));
      for (size_t k = 0; k < plain.bodies.size(); ++k) {
        const BodyId a = plain.bodies[k].id, b = with.bodies[k].id;
        if (!(plain.world.pose(a) == with.world.pose(b) && plain.world.velocity(a) == with.world.velocity(b))) ++apart;
      }
    }
    figures.push_back(atMost("bodies_apart", apart, 0, "bodies", std::string("scene=") + name));
  }
  return figures;
}

struct Churned {
  uint64_t hash = 0;
  int accepted = 0;  ///< ids of destroyed things that a call took
  bool finite = false;
};

template <class F>
bool refused(F&& call) {
  try {
    call();
  } catch (const Error&) {
    return true;
  }
  return false;
}

BodyId dropped(World& world, Draws& draws, BodyId neighbour) {
  BodyDef def;
  def.position = {3.0 * draws.next(), 3 + 2.0 * draws.next(), 3.0 * draws.next()};
  const uint32_t kind = draws.below(3);
  if (kind == 0) def.shape = Box{0.3f, 0.3f, 0.3f};
  if (kind == 1) def.shape = Sphere{0.3f};
  if (kind == 2) def.shape = Capsule{0.2f, 0.3f};
  const BodyId id = world.create(def);
  if (draws.below(4) == 0) {
    BallJoint joint;
    joint.bodyA = neighbour;
    joint.bodyB = id;
    const Pose p = world.pose(neighbour);
    joint.frameA.position = rotate(conjugate(p.rotation), def.position - p.position);
    world.create(joint);
  }
  return id;
}

Churned churnOnce(const Settings& settings) {
  constexpr int kTimes = 10000, kEachStep = 20, kBodies = 60;
  Build build("churn", settings);
  build.ground();
  World& world = build.world();
  Draws draws(99);
  std::vector<BodyId> alive{build.box("first", {0.5f, 0.5f, 0.5f}, {0, 1, 0}, 100)};
  while (alive.size() < kBodies) alive.push_back(dropped(world, draws, alive.back()));
  Churned result;
  for (int i = 0; i < kTimes; ++i) {
    const uint32_t slot = draws.below(kBodies);
    const BodyId gone = alive[slot];
    const std::vector<ShapeId> shapes = world.shapes(gone);
    world.destroy(gone);
    alive[slot] = dropped(world, draws, alive[(slot + 1) % kBodies]);
    result.accepted += world.isAlive(gone) || world.isAlive(shapes.front());
    result.accepted += !refused([&] { world.pose(gone); }) || !refused([&] { world.destroy(gone); });
    result.accepted += !refused([&] { world.geometry(shapes.front()); });
    if (i % kEachStep == 0) world.step(static_cast<float>(kDt));
  }
  result.finite = isFinite(world);
  result.hash = world.hash();
  return result;
}

std::vector<Figure> churn(const Settings& settings) {
  const Churned first = churnOnce(settings), second = churnOnce(settings);
  return {atMost("stale_ids_accepted", first.accepted, 0, "ids"), holds("same_bits", first.hash == second.hash),
          holds("finite", first.finite)};
}

// Boxes and balls on a turning mesh of waves, with a trigger, events, a hook, and friction against turning.
Model wavesModel(const Settings& settings) {
  Build build("waves", settings, {.moveEvents = true});
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  constexpr uint32_t kSide = 9;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const uint32_t x = i % kSide, z = i / kSide;
    const float height = 0.1f * static_cast<float>((x + z) % 3);
    vertices.push_back({0.5f * static_cast<float>(x) - 2, height, 0.5f * static_cast<float>(z) - 2});
    if (x + 1 == kSide || z + 1 == kSide) continue;
    triangles.push_back({i, i + kSide, i + kSide + 1});
    triangles.push_back({i, i + kSide + 1, i + 1});
  }
  BodyDef waves;
  waves.type = BodyType::Kinematic;
  waves.angularVelocity = {0, 0.1f, 0};
  waves.shapes.push_back({.geometry = Mesh{makeMesh({.vertices = vertices, .triangles = triangles})}});
  waves.shapes.push_back({.geometry = Sphere{0.6f}, .pose = {{0, 0.4, 0}, {}}, .isTrigger = true});
  build.add("waves", waves);
  for (int i = 0; i < 6; ++i) {
    BodyDef thing;
    thing.position = {0.7 * (i % 3) - 0.7, 0.6, 0.7 * (i / 3) - 0.3};
    thing.shapes.push_back({.geometry = i % 2 ? Geometry(Sphere{0.25f}) : Geometry(Box{0.3f, 0.2f, 0.25f}),
                            .hitEvents = true,
                            .contactHook = true});
    build.add("thing", thing);
  }
  build.world().setContactHook([](ContactPlan& plan) {
    plan.rollingFriction = plan.torsionalFriction = 0.05f;
    plan.inverseMassScaleA = 0.5f;
    return true;
  });
  return build.take();
}

// Cloth over two solids, in a trigger.
Model softsModel(const Settings& settings) {
  Build build("softs", settings);
  build.ground();
  BodyDef room;
  room.type = BodyType::Static;
  room.shapes.push_back({.geometry = Box{1, 0.4f, 1}, .isTrigger = true});
  build.add("room", room);
  for (int i = 0; i < 2; ++i)
    build.soft("solid" + std::to_string(i), {.mesh = makeTetBox({0.25f, 0.25f, 0.25f}, 3, 3, 3),
                                             .pose = {{0.03 * i, 0.27 + 0.56 * i, 0}, {}},
                                             .material = {.youngsModulus = 1e6f},
                                             .hitEvents = true});
  build.soft("cloth", {.mesh = makeClothGrid(0.6f, 0.6f, 12, 12), .pose = {{0, 1.2, 0}, {}}});
  return build.take();
}

// Stacks that are struck and fall asleep again and again: islands, too, use their memory again.
Figure sleepingAllocations(Settings settings) {
  settings.sleep = true;
  Model model = find("stacks")->make(settings);
  const auto round = [&] {
    model.world.addImpulse(model.bodies[1].id, {10, 0, 0});
    for (int i = 0; i < 90; ++i) model.world.step(static_cast<float>(kDt));
  };
  for (int i = 0; i < 5; ++i) round();
  const uint64_t before = allocationCount()();
  for (int i = 0; i < 80; ++i) model.world.step(static_cast<float>(kDt));
  const uint64_t made = allocationCount()() - before;
  return atMost("allocations", static_cast<double>(made), 0, "in 80 steps", "asleep");
}

// A settled scene's steps, after as many as it takes for every buffer to have grown.
std::vector<Figure> noAllocation(const Settings& settings) {
  std::vector<Figure> figures;
  for (const std::string name : {"stacks", "chain", "card_house", "heavy_on_light", "waves", "softs"}) {
    Model model = name == "waves"   ? wavesModel(settings)
                  : name == "softs" ? softsModel(settings)
                                    : find(name)->make(settings);
    for (int i = 0; i < 300; ++i) model.world.step(static_cast<float>(kDt));
    const uint64_t before = allocationCount()();
    for (int i = 0; i < 60; ++i) model.world.step(static_cast<float>(kDt));
    const uint64_t made = allocationCount()() - before;
    figures.push_back(atMost("allocations", static_cast<double>(made), 0, "in 60 steps", "scene=" + name));
  }
  figures.push_back(sleepingAllocations(settings));
  return figures;
}

}  // namespace

std::vector<Line> stateLines() {
  const Line counted = allocationCount() ? Line{"D", "no_allocation", noAllocation, ""}
                                         : Line{"D", "no_allocation", {}, "this program does not count allocations"};
  return {
      counted,
      {"D", "same_bits", sameBits, ""},
      {"D", "unrelated", unrelated, ""},
      {"D", "churn", churn, ""},
  };
}

}  // namespace avbd::scenes
