// Acceptance, soft bodies that touch themselves: no surface passes through itself at any step.
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/crossings.h"

namespace avbd::scenes {
namespace {

constexpr float kDt = 1.0f / 60;

/// Runs steps and counts those with a crossing.
class Watched {
 public:
  explicit Watched(World& world) : world_(world) {}
  void step() {
    world_.step(kDt);
    crossed_ += crossings(world_) > 0;
  }
  Figure figure(const char* what) const { return atMost("steps_with_crossings", crossed_, 0, "", what); }

 private:
  World& world_;
  int crossed_ = 0;
};

/// Ties the points of a cloth that `is` chooses by their places at rest to a body.
template <class Is>
std::vector<JointId> tie(World& world, SoftId cloth, BodyId to, Is&& is) {
  std::vector<JointId> ties;
  const auto mesh = world.mesh(cloth);
  const std::vector<BodyId> points = world.particles(cloth);
  const Pose pose = world.pose(to);
  for (size_t i = 0; i < points.size(); ++i)
    if (is(mesh->points()[i]))
      ties.push_back(world.create(
          BallJoint{.bodyA = points[i], .bodyB = to, .frameB = {world.pose(points[i]).position - pose.position, {}}}));
  return ties;
}

const SoftMaterial kCloth{.youngsModulus = 1e6f, .density = 300, .thickness = 0.001f, .bending = 1e-5f};
constexpr float kRadius = 0.004f;

/// One half of a cloth is turned over onto the other and let go.
Figure folded(const Settings& settings) {
  constexpr int kTurn = 120, kRest = 120;
  Build build("self", settings);
  build.ground();
  World& world = build.world();
  const SoftId id = world.create(SoftDef{
      .mesh = makeClothGrid(0.3f, 0.2f, 30, 20), .pose = {{0, 0.01, 0}, {}}, .material = kCloth, .radius = kRadius});
  const BodyId hinge = world.create(BodyDef{.type = BodyType::Kinematic, .position = {0, 0.02, 0}});
  const std::vector<JointId> ties = tie(world, id, hinge, [](Vec3 p) { return p.x > 0.299f; });
  Watched watched(world);
  world.setVelocity(hinge, {{}, {0, 0, 3.1f / (kTurn * kDt)}});
  for (int i = 0; i < kTurn; ++i) watched.step();
  for (const JointId joint : ties) world.destroy(joint);
  world.setVelocity(hinge, {});
  for (int i = 0; i < kRest; ++i) watched.step();
  return watched.figure("folded onto itself");
}

/// Its ends are turned against each other, and come nearer as it becomes a rope.
Figure twisted(const Settings& settings) {
  constexpr int kSteps = 240;
  World world(apply(settings, {}));
  const SoftId id =
      world.create(SoftDef{.mesh = makeClothGrid(0.15f, 0.5f, 15, 50), .material = kCloth, .radius = kRadius});
  Watched watched(world);
  for (const float side : {-1.0f, 1.0f}) {
    const BodyId end = world.create(BodyDef{.type = BodyType::Kinematic, .position = {0, 0, double{side} * 0.5}});
    tie(world, id, end, [&](Vec3 p) { return p.z * side > 0.499f; });
    world.setVelocity(end, {{0, 0, -side * 0.04f}, {0, 0, side * 4.0f}});
  }
  for (int i = 0; i < kSteps; ++i) watched.step();
  return watched.figure("twisted into a rope");
}

/// A ring of tetrahedra with a square section.
std::shared_ptr<const SoftMeshData> torus(float ring, float half, int around, int across) {
  std::vector<Vec3> points;
  std::vector<std::array<uint32_t, 4>> tets;
  const auto index = [&](int i, int j, int k) {
    return static_cast<uint32_t>(((i % around) * (across + 1) + j) * (across + 1) + k);
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j <= across; ++j)
      for (int k = 0; k <= across; ++k) {
        const double angle = 2 * 3.14159265358979 * i / around;
        const double r = double{ring} + double{half} * (2.0 * j / across - 1),
                     y = double{half} * (2.0 * k / across - 1);
        points.push_back(
            {static_cast<float>(r * std::cos(angle)), static_cast<float>(y), static_cast<float>(r * std::sin(angle))});
      }
  // Six tetrahedra a cell along its diagonal, alike in all cells.
  constexpr int kWays[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j)
      for (int k = 0; k < across; ++k)
        for (const auto& way : kWays) {
          int at[3] = {i, j, k};
          std::array<uint32_t, 4> tet{index(i, j, k)};
          for (size_t n = 0; n < 3; ++n) {
            ++at[way[n]];
            tet[n + 1] = index(at[0], at[1], at[2]);
          }
          tets.push_back(tet);
        }
  return makeTetMesh({points, tets});
}

/// Two walls press a ring until its hole is closed, and let it go.
Figure flattened(const Settings& settings) {
  constexpr int kPress = 120;
  Build build("self", settings);
  build.ground();
  World& world = build.world();
  world.create(SoftDef{.mesh = torus(0.3f, 0.08f, 32, 3),
                       .pose = {{0, 0.1, 0}, {}},
                       .material = {.youngsModulus = 2e5f, .density = 500},
                       .radius = kRadius});
  std::vector<BodyId> walls;
  for (const float side : {-1.0f, 1.0f}) {
    walls.push_back(world.create(BodyDef{
        .type = BodyType::Kinematic, .position = {double{side} * 0.45, 0.2, 0}, .shape = Box{0.05f, 0.19f, 1}}));
    world.setVelocity(walls.back(), {{-side * 0.2f / (kPress * kDt), 0, 0}, {}});
  }
  Watched watched(world);
  for (int i = 0; i < kPress; ++i) watched.step();
  for (size_t k = 0; k < 2; ++k) world.setVelocity(walls[k], {{(k == 0 ? -0.2f : 0.2f), 0, 0}, {}});
  for (int i = 0; i < kPress; ++i) watched.step();
  return watched.figure("torus flattened");
}

std::vector<Figure> self(const Settings& settings) {
  return {folded(settings), twisted(settings), flattened(settings)};
}

}  // namespace

std::vector<Line> selfLines() { return {{"S", "self", self, ""}}; }

}  // namespace avbd::scenes
