// Prints state hashes of small runs in every lane width: equal text from every compiler and level of optimisation.
#include <avbd/avbd.h>

#include <cinttypes>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace avbd;

void addGround(World& world) { world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}}); }

void buildPyramid(World& world) {
  addGround(world);
  for (int row = 0; row < 6; ++row) {
    for (int i = 0; i < 6 - row; ++i) {
      world.create(BodyDef{.position = {(i - (5 - row) / 2.0) * 1.1, 0.5 + row, 0}, .shape = Box{0.5f, 0.5f, 0.5f}});
    }
  }
}

void buildChain(World& world) {
  BodyId previous;
  for (int i = 0; i < 12; ++i) {
    const BodyId link = world.create(
        BodyDef{.position = {0.5 * i + 0.25, 8, 0}, .shape = Sphere{0.1f}, .mass = i < 11 ? 1.0f : 500.0f});
    const Vec3d atPrevious = i == 0 ? Vec3d{0, 8, 0} : Vec3d{0.25, 0, 0};
    world.create(BallJoint{.bodyA = previous, .bodyB = link, .frameA = {atPrevious}, .frameB = {{-0.25, 0, 0}}});
    previous = link;
  }
}

// Every shape, spin, friction, restitution, joints and overlap at once.
void buildMixed(World& world) {
  addGround(world);
  const Geometry geometries[] = {Sphere{0.4f}, Capsule{0.2f, 0.4f}, Box{0.5f, 0.3f, 0.4f}};
  BodyId previous;
  for (int i = 0; i < 24; ++i) {
    BodyDef def{.position = {0.7 * (i % 4), 0.3 + 0.6 * (i / 4), 0.6 * (i % 3)}, .shape = geometries[i % 3]};
    def.linearVelocity = {0.3f * static_cast<float>(i % 5), -1, 0.2f};
    def.angularVelocity = {1, 0.5f * static_cast<float>(i % 7), -2};
    def.material.restitution = i % 2 ? 0.5f : 0.0f;
    const BodyId body = world.create(def);
    if (i % 6 == 5) world.create(FixedJoint{.bodyA = previous, .bodyB = body, .frameA = {{0, 0.5, 0}}});
    previous = body;
  }
}

void run(const char* name, const std::function<void(World&)>& build, PrimalSolver solver, int width) {
  World world({.primalSolver = solver, .simdWidth = width});
  build(world);
  std::printf("%s %s", name, solver == PrimalSolver::Krylov ? "krylov" : "sweep");
  for (int step = 1; step <= 90; ++step) {
    world.step(1.0f / 60);
    if (step % 30 == 0) std::printf(" %016" PRIx64, world.hash());
  }
  std::printf("\n");
}

}  // namespace

// same_bits WIDTH: one line a run.
int main(int argc, char** argv) {
  const int width = argc > 1 ? std::stoi(argv[1]) : 0;
  const std::vector<std::pair<const char*, std::function<void(World&)>>> scenes = {
      {"pyramid", buildPyramid}, {"chain", buildChain}, {"mixed", buildMixed}};
  try {
    for (const auto& [name, build] : scenes) {
      for (const auto solver : {PrimalSolver::Krylov, PrimalSolver::BlockSweep}) run(name, build, solver, width);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
