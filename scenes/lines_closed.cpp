// Acceptance, soft and rigid in one solve: forces on both sides of what carries a load, and what a system that nothing
// outside touches keeps.
#include <algorithm>
#include <cmath>

#include "scenes/catalogue.h"
#include "scenes/measure.h"
#include "scenes/soft_lines.h"

namespace avbd::scenes {
namespace {

const SoftMaterial kRubber{.youngsModulus = 1e6f, .density = 400};
const SoftMaterial kSheet{.youngsModulus = 1e6f, .density = 400, .thickness = 0.001f, .bending = 1e-4f};

double massOf(const World& world, SoftId id) {
  double mass = 0;
  for (const BodyId p : world.particles(id)) mass += double{world.mass(p)};
  return mass;
}

/// Upward force [N] on one body from all that touches it.
double liftOf(const World& world, BodyId body) {
  double force = 0;
  for (const Contact& contact : world.contacts()) {
    if (contact.bodyA != body && contact.bodyB != body) continue;
    const double sign = contact.bodyB == body ? 1 : -1;
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& p = contact.points[static_cast<size_t>(i)];
      force += sign * (double{p.normalForce} * double{contact.normal.y} + double{p.frictionForce.y});
    }
  }
  return force;
}

/// Mean of what `of` tells over the last second of so many.
template <class F>
double settled(World& world, int seconds, F&& of) {
  double sum = 0;
  for (int i = 0; i < 60 * seconds; ++i) {
    world.step(1.0f / 60);
    if (i >= 60 * (seconds - 1)) sum += of() / 60;
  }
  return sum;
}

/// A soft cube lies on a plate that a joint holds: what the plate feels, and what the joint does.
void cubeOnPlate(const Settings& settings, std::vector<Figure>& figures) {
  Build build("both_sides", settings);
  const BodyId plate = build.box("plate", {0.5f, 0.05f, 0.5f}, {0, 1, 0}, 20);
  const JointId held = build.join(FixedJoint{}, {}, plate, {{0, 1, 0}, {}});
  const SoftId cube = build.soft(
      "cube", {.mesh = makeTetBox({0.25f, 0.25f, 0.25f}, 4, 4, 4), .pose = {{0, 1.312, 0}, {}}, .material = kRubber});
  World& world = build.world();
  double pressed = 0;
  const double joint = settled(world, 5, [&] {
    pressed = -liftOf(world, plate);
    return std::fabs(double{world.reaction(held).force.y});
  });
  const double weight = massOf(world, cube) * double{kGravity};
  figures.push_back(within("on_plate", pressed / weight, 1, 0.01, "of the cube", "soft cube on a plate"));
  figures.push_back(
      within("on_support", joint / (weight + 20 * double{kGravity}), 1, 0.01, "of both", "soft cube on a plate"));
}

/// A rigid box lies on a soft cube on that plate.
void boxOnCube(const Settings& settings, std::vector<Figure>& figures) {
  constexpr float kBox = 50, kPlate = 20;
  Build build("both_sides", settings);
  const BodyId plate = build.box("plate", {0.5f, 0.05f, 0.5f}, {0, 1, 0}, kPlate);
  const JointId held = build.join(FixedJoint{}, {}, plate, {{0, 1, 0}, {}});
  const SoftId cube = build.soft(
      "cube", {.mesh = makeTetBox({0.25f, 0.25f, 0.25f}, 4, 4, 4), .pose = {{0, 1.312, 0}, {}}, .material = kRubber});
  const BodyId box = build.box("box", {0.2f, 0.1f, 0.2f}, {0, 1.68, 0}, kBox);
  World& world = build.world();
  double onBox = 0, onPlate = 0;
  const double joint = settled(world, 6, [&] {
    onBox = liftOf(world, box), onPlate = -liftOf(world, plate);
    return std::fabs(double{world.reaction(held).force.y});
  });
  const double g = double{kGravity}, cubes = massOf(world, cube) * g;
  const char* what = "box on a soft cube on a plate";
  figures.push_back(within("on_box", onBox / (kBox * g), 1, 0.01, "of its weight", what));
  figures.push_back(within("on_plate", onPlate / (kBox * g + cubes), 1, 0.01, "of box and cube", what));
  figures.push_back(within("on_support", joint / ((kBox + kPlate) * g + cubes), 1, 0.01, "of all", what));
}

/// A rigid box lies in cloth that hangs from joints along two of its edges.
void boxInHammock(const Settings& settings, std::vector<Figure>& figures) {
  constexpr float kBox = 5;
  Build build("both_sides", settings);
  const auto mesh = makeClothGrid(0.6f, 0.4f, 24, 16);
  const SoftId cloth =
      build.soft("hammock", {.mesh = mesh,
                             .pose = {{0, 1, 0}, {}},
                             .material = {.youngsModulus = 1e7f, .density = 400, .thickness = 0.001f, .bending = 1e-4f},
                             .radius = 0.005f});
  const BodyId box = build.box("box", {0.15f, 0.1f, 0.15f}, {0, 1.11, 0}, kBox);
  World& world = build.world();
  const std::vector<BodyId> particles = world.particles(cloth);
  std::vector<JointId> ties;
  for (size_t i = 0; i < particles.size(); ++i)
    if (std::fabs(mesh->points()[i].x) > 0.599f)
      ties.push_back(build.joint({}, particles[i], world.pose(particles[i]).position));
  double onBox = 0;
  const double carried = settled(world, 15, [&] {
    double sum = 0;
    for (const JointId tie : ties) sum += double{world.reaction(tie).force.y};
    onBox = liftOf(world, box);
    return std::fabs(sum);
  });
  const double g = double{kGravity};
  figures.push_back(within("on_box", onBox / (kBox * g), 1, 0.01, "of its weight", "box in a hammock"));
  figures.push_back(
      within("on_supports", carried / (kBox * g + massOf(world, cloth) * g), 1, 0.01, "of both", "box in a hammock"));
}

std::vector<Figure> bothSides(const Settings& settings) {
  std::vector<Figure> figures;
  cubeOnPlate(settings, figures);
  boxOnCube(settings, figures);
  boxInHammock(settings, figures);
  return figures;
}

/// Cloth, a soft cube, boxes and a joint, thrown at one another where nothing weighs anything.
struct Thrown {
  Build build;
  std::vector<std::vector<BodyId>> parts;  ///< what flies as one

  Thrown(const Settings& settings, float speed) : build("closed_system", settings, weightless()) {
    const float v = speed;
    const SoftId cloth =
        build.soft("cloth", {.mesh = makeClothGrid(0.4f, 0.4f, 16, 16), .material = kSheet, .radius = 0.008f});
    const SoftId cube = build.soft("cube", {.mesh = makeTetBox({0.15f, 0.15f, 0.15f}, 3, 3, 3),
                                            .pose = {{0.05, 0.5, 0.02}, turned({0.6, 0, 0.8}, 0.7)},
                                            .velocity = {{0, -v, 0}, {0, 1, 0}},
                                            .material = kRubber});
    const BodyId below = build.box("below", {0.1f, 0.1f, 0.1f}, {0.1, -0.5, 0}, 4, {{0, v, 0}, {1, 0, 2}});
    const BodyId beside = build.box("beside", {0.08f, 0.12f, 0.1f}, {-0.6, -0.25, 0.1}, 3, {{v, 0, 0}, {0, 1, 0}});
    const BodyId tail = build.box("tail", {0.06f, 0.06f, 0.06f}, {0.55, 0, 0.55}, 1, {{0, 0, -v / 4}, {}});
    const BodyId last = build.box("last", {0.06f, 0.06f, 0.06f}, {0.75, 0, 0.75}, 1, {{0, 0, -v / 4}, {}});
    build.joint(tail, last, {0.65, 0, 0.65});
    // The cloth's last corner carries the two.
    build.joint(build.world().particles(cloth).back(), tail, {0.4, 0, 0.4});
    parts = {build.world().particles(cloth), build.world().particles(cube), {below}, {beside}, {tail, last}};
  }

  Vec3d momentumOf(const std::vector<BodyId>& part) {
    Vec3d sum;
    for (const BodyId id : part)
      sum = sum + toDouble(build.world().velocity(id).linear) * double{build.world().mass(id)};
    return sum;
  }
  Vec3d center(double& mass) {
    Vec3d sum;
    mass = 0;
    for (const auto& part : parts)
      for (const BodyId id : part) {
        sum = sum + build.world().worldCenterOfMass(id) * double{build.world().mass(id)};
        mass += double{build.world().mass(id)};
      }
    return sum * (1 / mass);
  }
};

/// Drift of momentum. Points that stop at a surface go less far along their own way and keep their velocity: that
/// shifts the centre of mass and neither momentum.
std::vector<Figure> throwTogether(const Settings& settings, float speed, int steps) {
  Thrown thrown(settings, speed);
  World& world = thrown.build.world();
  const Momentum start = momentum(world);
  std::vector<Vec3d> before;
  for (const auto& part : thrown.parts) before.push_back(thrown.momentumOf(part));
  double linear = 0, angular = 0, astray = 0, mass = 0;
  const Vec3d from = thrown.center(mass);
  for (int i = 1; i <= steps; ++i) {
    world.step(1.0f / 60);
    const Momentum now = momentum(world);
    linear = std::max(linear, length(now.linear - start.linear) / start.linearScale);
    angular = std::max(angular, length(now.angular - start.angular) / start.angularScale);
    astray = std::max(astray, length(thrown.center(mass) - from - start.linear * (i / 60.0 / mass)));
  }
  double exchanged = 1;
  for (size_t k = 0; k < before.size(); ++k)
    exchanged = std::min(exchanged, length(thrown.momentumOf(thrown.parts[k]) - before[k]) / start.linearScale);
  const std::string what = text(double{speed}) + " m/s";
  // Of momenta a hundred times the rounding of floats. What stops may lose a tenth of one step's way.
  return {Figure{"least_exchange", what, exchanged, 0.001, 1, "of all sizes"},
          atMost("linear_momentum", linear, 1e-5, "of all sizes", what),
          atMost("angular_momentum", angular, 1e-5, "of all sizes", what),
          atMost("center_astray", astray, 0.1 * double{speed} / 60, "m", what)};
}

std::vector<Figure> closedSystem(const Settings& settings) { return throwTogether(settings, 1.2f, 240); }

/// Bodies fast enough for their own search for impacts. One that meets a slower one goes the rest of its way with that,
/// aside of its own, which costs angular momentum; and at half a metre a step crumpled cloth and what it is wrapped
/// around stop where they are, step by step, while their velocities go on.
std::vector<Figure> closedFast(const Settings& settings) {
  std::vector<Figure> figures = throwTogether(settings, 2.5f, 120);
  for (Figure& figure : throwTogether(settings, 25, 30)) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace

std::vector<Line> closedLines() {
  return {{"S", "both_sides", bothSides, ""},
          {"S", "closed_system", closedSystem, ""},
          {"S", "closed_fast", closedFast, ""}};
}

}  // namespace avbd::scenes
