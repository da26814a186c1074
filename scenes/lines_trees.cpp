// Acceptance, articulations: bases, long and heavy chains, a floating figure, mirrored mechanisms.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/catalogue.h"
#include "scenes/ragdolls.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

const Quat kAlongZ = along({0, 0, 1});

enum class Pin : uint8_t { Ball, Hinge };

void pin(Build& build, Pin kind, BodyId a, BodyId b, Vec3d at) {
  if (kind == Pin::Ball)
    build.joint(a, b, at);
  else
    build.join(HingeJoint{}, a, b, {at, kAlongZ});
}

const char* nameOf(Pin kind) { return kind == Pin::Ball ? "joint=ball" : "joint=hinge"; }

/// Largest gap of any joint over the steps.
double gapOver(Model& model, int steps) {
  const Layout layout = layoutOf(model.world);
  double gap = 0;
  for (int i = 0; i < steps; ++i) {
    model.world.step(static_cast<float>(kDt));
    gap = std::max(gap, jointGapMax(layout, posesOf(model.world, layout)));
  }
  return isFinite(model.world) ? gap : NAN;
}

// The arm falls from horizontal and swings.
std::vector<Figure> fixedBase(const Settings& settings) {
  Build build("fixed_base", settings);
  build.filter(kGhost);
  const Vec3d at{0, 5, 0};
  const BodyId base = build.box("base", {0.1f, 0.1f, 0.1f}, at, 0.08f);
  const BodyId arm = build.box("arm", {0.5f, 0.05f, 0.05f}, {0.6, 5, 0}, 0.1f);
  build.join(FixedJoint{}, {}, base, {at, {}});
  build.join(HingeJoint{}, base, arm, {{0.1, 5, 0}, kAlongZ});
  Model model = build.take();
  double moved = 0, lowest = 0;
  for (int i = 0; i < stepsFor(10, kDt); ++i) {
    model.world.step(static_cast<float>(kDt));
    moved = std::max(moved, length(model.world.pose(base).position - at));
    lowest = std::min(lowest, model.world.pose(arm).position.y - 5);
  }
  return {atMost("base_moves", moved, 1e-4, "m"), within("arm_swings_down", lowest, -0.5, 0.01, "m")};
}

/// Links in a row along x from a fixed point.
Model rowOf(const Settings& settings, Pin kind, std::span<const float> masses, double length) {
  Build build("row", settings);
  build.filter(kGhost);
  const float half = static_cast<float>(length / 2), thick = half / 5;
  BodyId previous;
  for (size_t i = 0; i < masses.size(); ++i) {
    const double x = length * static_cast<double>(i);
    const BodyId link = build.box("link", {half, thick, thick}, {x + length / 2, 0, 0}, masses[i]);
    pin(build, kind, previous, link, {x, 0, 0});
    previous = link;
  }
  return build.take();
}

std::vector<Figure> chain100(const Settings& settings) {
  std::vector<Figure> figures;
  const std::vector<float> masses(100, 1.0f);
  for (const Pin kind : {Pin::Ball, Pin::Hinge}) {
    Model model = rowOf(settings, kind, masses, 0.25);
    figures.push_back(atMost("gap", gapOver(model, 600), 0.001, "m", nameOf(kind)));
  }
  return figures;
}

// Links of a metre fall from horizontal, 10 s.
std::vector<Figure> massTree(const Settings& settings) {
  std::vector<Figure> figures;
  std::vector<float> masses{5000, 2000, 500, 100, 50};
  for (const char* order : {"heavy_first", "heavy_last"}) {
    for (const Pin kind : {Pin::Ball, Pin::Hinge}) {
      Model model = rowOf(settings, kind, masses, 1);
      figures.push_back(atMost("gap", gapOver(model, 600), 0.001, "m", std::string(nameOf(kind)) + " order=" + order));
    }
    std::reverse(masses.begin(), masses.end());
  }
  return figures;
}

/// Moves the figure's joints to and fro: hinges about their middle, the others by a turn about one axis.
void drive(World& world, const Ragdoll& doll, double time) {
  for (size_t i = 0; i < doll.joints.size(); ++i) {
    const JointId id = doll.joints[i];
    const double phase = 3 * time + 0.7 * static_cast<double>(i);
    if (world.type(id) == JointType::Hinge) {
      const JointLimit limit = world.hingeJoint(id).limit;
      const double middle = (limit.lower + limit.upper) / 2, reach = (limit.upper - limit.lower) / 3;
      world.setDrive(
          id, {.stiffness = 100, .damping = 10, .position = static_cast<float>(middle + reach * std::sin(phase))});
    } else {
      world.setSlerp(id,
                     {.stiffness = 100, .damping = 10, .rotation = turned({0, 0.6f, 0.8f}, 0.25 * std::sin(phase))});
    }
  }
}

// Momentum changes against the largest sums of the bodies' magnitudes: of all of them together the figure drifts at
// 0.5 m/s and turns at 0.5 rad/s.
std::vector<Figure> floating(const Settings& settings) {
  WorldDef def;
  def.gravity = {};
  Build build("floating", settings, def);
  build.filter(kGhost);
  const Ragdoll doll = addRagdoll(build, "doll", {}, {{0.3f, 0, 0.4f}, {0.3f, 0.4f, 0}});
  Model model = build.take();
  const Momentum start = momentum(model.world);
  double linear = 0, angular = 0, linearScale = 0, angularScale = 0, bent = 0;
  const JointId elbow = doll.joints[4];
  for (int i = 0; i < stepsFor(5, kDt); ++i) {
    drive(model.world, doll, i * kDt);
    model.world.step(static_cast<float>(kDt));
    const Momentum now = momentum(model.world);
    linear = std::max(linear, length(now.linear - start.linear));
    angular = std::max(angular, length(now.angular - start.angular));
    linearScale = std::max(linearScale, now.linearScale);
    angularScale = std::max(angularScale, now.angularScale);
    bent = std::min(bent, model.world.coordinate(elbow).position);
  }
  return {atMost("linear_momentum", linear / linearScale, 1e-4, "of the magnitudes"),
          atMost("angular_momentum", angular / angularScale, 1e-4, "of the magnitudes"),
          holds("bends", bent < -1.0, "joint=elbow")};
}

/// The mirror image in the plane x = 0.
Pose mirrorOf(const Pose& p) {
  return {{-p.position.x, p.position.y, p.position.z}, {p.rotation.w, p.rotation.x, -p.rotation.y, -p.rotation.z}};
}

/// Three links on hinges about three directions, as they are or mirrored.
struct Mechanism {
  std::array<BodyId, 3> links;
  std::array<JointId, 3> joints;
};

Mechanism addMechanism(Build& build, bool mirrored) {
  const auto see = [&](const Pose& p) { return mirrored ? mirrorOf(p) : p; };
  const Vec3 axes[3] = {{0, 0.6f, 0.8f}, {0.6f, 0.8f, 0}, {0, 0, 1}};
  Mechanism m;
  BodyId previous;
  for (size_t i = 0; i < 3; ++i) {
    const double x = 1 + 0.8 * static_cast<double>(i);
    const Pose at = see({{x + 0.4, 0, 0}, turned({0.8f, 0, 0.6f}, 0.3)});
    m.links[i] = build.box("link", {0.3f, 0.1f, 0.05f}, at.position, 2, {}, at.rotation);
    // A hinge's axis is no arrow: a mirror turns it about, so that the same angle looks mirrored.
    m.joints[i] = build.join(HingeJoint{}, previous, m.links[i], see({{x, 0, 0}, along(axes[i])}));
    previous = m.links[i];
  }
  return m;
}

std::vector<Figure> mirror(const Settings& settings) {
  Build build("mirror", settings);
  build.filter(kGhost);
  const Mechanism right = addMechanism(build, false), left = addMechanism(build, true);
  Model model = build.take();
  double worst = 0, moved = 0;
  const Vec3d start = model.world.pose(right.links[2]).position;
  for (int i = 0; i < stepsFor(10, kDt); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const float target = static_cast<float>(0.8 * std::sin((2 + static_cast<double>(k)) * i * kDt));
      const JointDrive drive{.stiffness = 300, .damping = 30, .position = target};
      for (const Mechanism* m : {&right, &left}) model.world.setDrive(m->joints[k], drive);
    }
    model.world.step(static_cast<float>(kDt));
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d a = model.world.pose(right.links[k]).position;
      worst = std::max(worst, length(mirrorOf(model.world.pose(left.links[k])).position - a));
    }
    moved = std::max(moved, length(model.world.pose(right.links[2]).position - start));
  }
  return {atMost("mirror_error", worst, 1e-4, "m"), holds("moves", moved > 0.5)};
}

}  // namespace

std::vector<Line> treeLines() {
  return {{"A", "fixed_base", fixedBase, ""},
          {"A", "chain100", chain100, ""},
          {"A", "mass_tree", massTree, ""},
          {"A", "floating", floating, ""},
          {"A", "mirror", mirror, ""}};
}

}  // namespace avbd::scenes
