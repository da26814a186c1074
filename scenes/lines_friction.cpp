// Acceptance, friction: sliding, slopes, sticking and slipping.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr Box kFlat{1, 0.25f, 1};
constexpr double kDegree = 3.14159265358979323846 / 180;

void stepFor(World& world, double seconds, double dt) {
  const int n = stepsFor(seconds, dt);
  for (int i = 0; i < n; ++i) world.step(static_cast<float>(dt));
}

double stopDistance(double v, double mu, double dt) { return v * v / (2 * mu * kGravity) - v * dt / 2; }

std::vector<Figure> slide(const Settings& settings) {
  std::vector<Figure> figures;
  for (const float mu : {0.1f, 0.2f, 0.4f, 0.5f, 0.6f, 0.8f, 1.0f})
    for (Figure& f : trySlide(settings, mu, kDt)) figures.push_back(std::move(f));
  return figures;
}

std::vector<Figure> slideDiagonal(const Settings& settings) {
  Model model = slidingBox(settings, 0.5f, {3, 0, 3});
  const BodyId box = model.bodies.back().id;
  const Vec3d from = model.world.pose(box).position;
  stepFor(model.world, 2, kDt);
  const Vec3d d = model.world.pose(box).position - from;
  const double v = std::sqrt(18.0);
  return {within("path", std::hypot(d.x, d.z), stopDistance(v, 0.5, kDt), 0.02, "m"),
          atMost("axes_apart", std::abs(d.x - d.z) / std::max(std::abs(d.x), 1e-9), 0.001, "of x"),
          atMost("speed_end", speedMax(model.world), 1e-3, "m/s")};
}

// A flat box on a slope that falls towards +x; the way it goes down in the given time.
double slip(const Settings& settings, double degrees, double seconds) {
  Build build("slope", settings);
  const double a = degrees * kDegree;
  const Quat tilt = turned({0, 0, 1}, -a);
  const Vec3d normal{std::sin(a), std::cos(a), 0}, down{std::cos(a), -std::sin(a), 0};
  build.fixedBox("slope", {100, 1, 100}, normal * -1, tilt);
  const Vec3d from = normal * 0.25;
  const BodyId box = build.box("box", kFlat, from, 1000, {}, tilt);
  Model model = build.take();
  stepFor(model.world, seconds, kDt);
  return dot(model.world.pose(box).position - from, down);
}

std::vector<Figure> slopeHold(const Settings& settings) {
  return {atMost("creep", std::abs(slip(settings, 30.5, 30)), 0.005, "m", "slope=30.5 time=30")};
}

std::vector<Figure> slopeSlip(const Settings& settings) {
  return {within("path", slip(settings, 32, 2), 0.414, 0.06, "m", "slope=32 time=2")};
}

std::vector<Figure> stackSlide(const Settings& settings) {
  Build build("stack_slide", settings);
  build.friction(0).ground();
  build.friction(0.4f);
  const BodyId lower = build.box("lower", {3, 0.5f, 1.5f}, {0, 0.5, 0}, 800);
  const BodyId upper = build.box("upper", {0.5f, 0.5f, 0.5f}, {-1, 1.5, 0}, 80, {{3, 0, 0}, {}});
  Model model = build.take();
  const double before = momentum(model.world).linear.x;
  stepFor(model.world, 2, kDt);
  const double common = 3.0 * 80 / 880;
  return {within("momentum", momentum(model.world).linear.x, before, 0.001, "kg m/s"),
          within("speed_lower", model.world.velocity(lower).linear.x, common, 0.01, "m/s"),
          within("speed_upper", model.world.velocity(upper).linear.x, common, 0.01, "m/s")};
}

std::vector<Figure> staticDynamic(const Settings& settings) {
  Build build("static_dynamic", settings);
  Material material;
  material.friction = 0.4f;
  material.staticFriction = 0.8f;
  build.surface(material).ground();
  const BodyId box = build.box("box", kFlat, {0, 0.25, 0}, 100);
  Model model = build.take();
  const double weight = 100 * kGravity;
  double started = -1, startSpeed = 0, startTime = 0, expected = 0;
  for (int i = 0; i < stepsFor(9, kDt); ++i) {
    const double time = (i + 1) * kDt, ratio = 0.1 * time;
    model.world.addForce(box, {static_cast<float>(ratio * weight), 0, 0});
    model.world.step(static_cast<float>(kDt));
    const double speed = model.world.velocity(box).linear.x;
    if (started >= 0) expected += (ratio - 0.4) * kGravity * kDt;
    if (started < 0 && speed > 0.01) {
      started = ratio;
      startSpeed = speed;
      startTime = time;
    }
    if (started >= 0 && time >= startTime + 0.5) {
      startSpeed = speed - startSpeed;
      break;
    }
  }
  return {within("starts_at", started, 0.8, 0.02, "of the weight"),
          within("gain", startSpeed, expected > 0 ? expected : NAN, 0.02, "m/s in 0.5 s")};
}

}  // namespace

Model slidingBox(const Settings& settings, float mu, Vec3 velocity, Scale scale) {
  const float l = scale.length;
  WorldDef def;
  def.gravity = {0, -kGravity * l, 0};
  def.lengthUnit = l;
  def.maxDepenetrationSpeed *= l;
  def.restitutionThreshold *= l;
  Build build("slide", settings, def);
  build.friction(mu);
  build.fixedBox("ground", {100 * l, l, 100 * l}, {0, -l, 0});
  build.box("box", {kFlat.x * l, kFlat.y * l, kFlat.z * l}, {0, 0.25 * l, 0}, 1000 * scale.mass, {velocity * l, {}});
  return build.take();
}

std::vector<Figure> trySlide(const Settings& settings, float mu, double dt) {
  Model model = slidingBox(settings, mu, {5, 0, 0});
  const BodyId box = model.bodies.back().id;
  const double from = model.world.pose(box).position.x;
  stepFor(model.world, 5 / (mu * kGravity) + 1, dt);
  const std::string params = "mu=" + text(mu) + " rate=" + text(std::round(1 / dt));
  return {within("path", model.world.pose(box).position.x - from, stopDistance(5, mu, dt), 0.02, "m", params),
          atMost("speed_end", speedMax(model.world), 1e-3, "m/s", params)};
}

std::vector<Line> frictionLines() {
  return {
      {"R", "slide", slide, ""},
      {"R", "slide_diagonal", slideDiagonal, ""},
      {"R", "slope_hold", slopeHold, ""},
      {"R", "slope_slip", slopeSlip, ""},
      {"R", "stack_slide", stackSlide, ""},
      {"R", "static_dynamic", staticDynamic, ""},
  };
}

}  // namespace avbd::scenes
