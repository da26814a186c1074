// Acceptance, motion: rolling, bouncing, spinning, falling together.
#include <algorithm>
#include <cmath>
#include <optional>

#include "scenes/catalogue.h"
#include "scenes/joint_kinds.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr Box kUnit{0.5f, 0.5f, 0.5f};

WorldDef weightless() {
  WorldDef def;
  def.gravity = {};
  return def;
}

std::string rate(double dt) { return "rate=" + text(std::round(1 / dt)); }

std::vector<Figure> bounce(const Settings& settings) {
  std::vector<Figure> figures;
  for (const float e : {0.3f, 0.6f, 0.9f})
    for (Figure& f : tryBounce(settings, e, kDt)) figures.push_back(std::move(f));
  return figures;
}

std::vector<Figure> spinFree(const Settings& settings) {
  Build build("spin_free", settings, weightless());
  const BodyId box = build.box("box", kUnit, {0, 0, 0}, 1000, {{}, {0, 2, 0}});
  Model model = build.take();
  for (int i = 0; i < stepsFor(5, kDt); ++i) model.world.step(static_cast<float>(kDt));
  return {within("spin", length(toDouble(model.world.velocity(box).angular)), 2, 1e-4, "rad/s")};
}

std::vector<Figure> dzhanibekov(const Settings& settings) {
  Build build("dzhanibekov", settings, weightless());
  // A little off the middle axis, so that it turns over.
  build.box("box", {0.5f, 1, 1.5f}, {0, 0, 0}, 6000, {{}, {0.01f, 5, 0.01f}});
  Model model = build.take();
  const Vec3d l0 = momentum(model.world).angular;
  const double e0 = energy(model.world);
  double size = 0, angle = 0, loss = 0, turned = 1;
  for (int i = 0; i < stepsFor(20, kDt); ++i) {
    model.world.step(static_cast<float>(kDt));
    const Vec3d l = momentum(model.world).angular;
    size = std::max(size, std::abs(length(l) / length(l0) - 1));
    angle = std::max(angle, std::acos(std::min(1.0, dot(l, l0) / (length(l) * length(l0)))));
    loss = std::max(loss, std::abs(energy(model.world) / e0 - 1));
    const Vec3d up = rotate(model.world.pose(model.bodies[0].id).rotation, Vec3d{0, 1, 0});
    turned = std::min(turned, up.y / length(up));  // a rotation of floats is a unit one but for their rounding
  }
  return {atMost("momentum_size", size, 5e-4, "relative"),
          atMost("momentum_direction", angle, 5e-4, "rad"),
          atMost("energy", loss, 0.005, "relative"),
          {"turned_over", "", turned, -1, -0.9, "cosine"}};
}

/// A pair in contact, or joined where they touch; what spans goes from middle to middle.
double fallError(const Settings& settings, std::optional<JointKind> kind, Vec3d offset) {
  Build build("fall_together", settings);
  const BodyId a = build.box("a", kUnit, {0, 0, 0}, 1000), b = build.box("b", kUnit, offset, 200);
  if (kind) {
    const Vec3d middle = offset * 0.5;
    connect(build, *kind, a, b, spans(*kind) ? Spot{{}, offset} : Spot{middle, middle, along(toFloat(offset))});
  }
  Model model = build.take();
  double worst = 0;
  for (int i = 0; i < stepsFor(1, kDt); ++i) {
    const Vec3d before[2] = {toDouble(model.world.velocity(a).linear), toDouble(model.world.velocity(b).linear)};
    model.world.step(static_cast<float>(kDt));
    for (int k = 0; k < 2; ++k) {
      const Vec3d gain = toDouble(model.world.velocity(k ? b : a).linear) - before[k];
      const Vec3d error = gain * (1 / kDt) - Vec3d{0, -kGravity, 0};
      worst = std::max(worst, length(error) / kGravity);
    }
  }
  return worst;
}

// A pulley hangs from its wheels: its pair does not fall.
std::vector<Figure> fallTogether(const Settings& settings) {
  std::vector<std::optional<JointKind>> kinds{std::nullopt};
  for (const JointKind kind : kJointKinds)
    if (kind != JointKind::Pulley) kinds.push_back(kind);
  std::vector<Figure> figures;
  for (const auto& kind : kinds) {
    const std::string pair = std::string("pair=") + (kind ? nameOf(*kind) : "contact");
    figures.push_back(atMost("acceleration", fallError(settings, kind, {0, 1, 0}), 1e-4, "of g", pair + " side=above"));
    figures.push_back(
        atMost("acceleration", fallError(settings, kind, {1, 0, 0}), 1e-4, "of g", pair + " side=beside"));
  }
  return figures;
}

}  // namespace

std::vector<Figure> tryRoll(const Settings& settings, double dt) {
  Build build("roll", settings);
  build.friction(0.5f);
  build.ground();
  const BodyId ball = build.ball("ball", 0.5f, {0, 0.5, 0}, 100, {{3, 0, 0}, {}});
  Model model = build.take();
  const auto run = [&](double seconds) {
    for (int i = 0; i < stepsFor(seconds, dt); ++i) model.world.step(static_cast<float>(dt));
    return static_cast<double>(model.world.velocity(ball).linear.x);
  };
  const double rolling = run(1), spin = -0.5 * model.world.velocity(ball).angular.z, later = run(5);
  return {within("speed", rolling, 15.0 / 7, 0.003, "m/s", rate(dt)),
          within("spin_times_radius", spin, 15.0 / 7, 0.003, "m/s", rate(dt)),
          {"loss_a_second", rate(dt), (1 - later / rolling) / 5, -0.001, 0.001, "relative"}};
}

std::vector<Figure> tryBounce(const Settings& settings, float restitution, double dt) {
  Build build("bounce", settings);
  Material material;
  material.restitution = restitution;
  material.friction = kFriction;
  build.surface(material).ground();
  const BodyId ball = build.ball("ball", 0.5f, {0, 5, 0}, 100);
  Model model = build.take();
  double rise[3] = {0, 0, 0};
  int bounces = 0;
  double before = 0;
  for (int i = 0; i < stepsFor(12, dt) && bounces < 3; ++i) {
    model.world.step(static_cast<float>(dt));
    const double v = model.world.velocity(ball).linear.y;
    if (before < 0 && v > 0) ++bounces;
    // A landing can spread over two steps; the sign of the speed tells flight upwards from downwards.
    if (bounces > 0 && bounces < 3) rise[bounces] = std::max(rise[bounces], model.world.pose(ball).position.y - 0.5);
    before = v;
  }
  std::vector<Figure> figures;
  double target = 4.5, speed = std::sqrt(2 * kGravity * 4.5);
  for (int k = 1; k <= 2; ++k) {
    target *= static_cast<double>(restitution) * restitution;
    const double slack = 0.02 * target + speed * dt;
    figures.push_back({"rise_" + std::to_string(k), "e=" + text(restitution) + " " + rate(dt), rise[k], target - slack,
                       target + slack, "m"});
    speed *= restitution;
  }
  return figures;
}

std::vector<Line> motionLines() {
  return {
      {"R", "roll", [](const Settings& s) { return tryRoll(s, kDt); }, ""},
      {"R", "bounce", bounce, ""},
      {"R", "spin_free", spinFree, ""},
      {"R", "dzhanibekov", dzhanibekov, ""},
      {"R", "fall_together", fallTogether, ""},
  };
}

}  // namespace avbd::scenes
