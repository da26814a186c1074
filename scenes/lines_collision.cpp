// Acceptance, collisions: momentum, overlap, a million to one.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr Box kUnit{0.5f, 0.5f, 0.5f};

WorldDef weightless() {
  WorldDef def;
  def.gravity = {};
  return def;
}

// Fifty boxes of several sizes fly towards the middle.
Model crowd(const Settings& settings) {
  Build build("momentum", settings, weightless());
  Draws draws(7);
  for (int i = 0; i < 50; ++i) {
    const Vec3d cell{i % 4 - 1.5, (i / 4) % 4 - 1.5, i / 16 - 1.5};
    const Vec3d at = cell * 2.2 + Vec3d{0.1 * draws.next(), 0.1 * draws.next(), 0.1 * draws.next()};
    const Box half{0.45f + 0.1f * draws.next(), 0.45f + 0.1f * draws.next(), 0.45f + 0.1f * draws.next()};
    const Vec3 wander{draws.next(), draws.next(), draws.next()}, spin{draws.next(), draws.next(), draws.next()};
    const float mass = 500 * (1 + 0.8f * draws.next());
    build.box("box_" + std::to_string(i), half, at, mass, {toFloat(at) * -1.0f + wander, spin});
  }
  return build.take();
}

std::vector<Figure> conserve(const Settings& settings) {
  Model model = crowd(settings);
  const Momentum start = momentum(model.world);
  double linear = 0, angular = 0, contacts = 0;
  for (int i = 0; i < stepsFor(5, kDt); ++i) {
    contacts = std::max<double>(contacts, model.world.step(static_cast<float>(kDt)).contacts);
    const Momentum now = momentum(model.world);
    linear = std::max(linear, length(now.linear - start.linear) / start.linearScale);
    angular = std::max(angular, length(now.angular - start.angular) / start.angularScale);
  }
  return {atMost("linear", linear, 1e-3, "of the sum"),
          atMost("angular", angular, 1e-3, "of the sum"),
          {"contacts", "", contacts, 10, 1e6, "pairs"},
          holds("finite", isFinite(model.world))};
}

std::vector<Figure> deepOverlap(const Settings& settings) {
  std::vector<Figure> figures;
  for (const double dt : {1.0 / 60, 1.0 / 240}) {
    Build build("deep_overlap", settings, weightless());
    const BodyId a = build.box("a", kUnit, {0, 0, 0}, 1000), b = build.box("b", kUnit, {0.5, 0, 0}, 1000);
    Model model = build.take();
    const Layout layout = layoutOf(model.world);
    double fastest = 0;
    for (int i = 0; i < stepsFor(1, dt); ++i) {
      model.world.step(static_cast<float>(dt));
      const Vec3 apart = model.world.velocity(b).linear - model.world.velocity(a).linear;
      fastest = std::max(fastest, length(toDouble(apart)));
    }
    const std::string params = "rate=" + text(std::round(1 / dt));
    const double overlap = penetrationOf(layout, posesOf(model.world, layout)).max;
    figures.push_back(atMost("overlap_after_1s", overlap, 0, "m", params));
    figures.push_back(atMost("speed_apart", fastest, 3 * 1.05, "m/s", params));
  }
  return figures;
}

// The wall is one layer high: a higher one would fall, and fast, whatever hits it.
std::vector<Figure> millionToOne(const Settings& settings) {
  Build build("million_to_one", settings);
  build.friction(0).ground();
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k < 4; ++k)
      build.box("box_" + std::to_string(i) + "_" + std::to_string(k), kUnit, {double(i), 0.5, k - 1.5}, 1);
  const BodyId heavy = build.box("heavy", kUnit, {-1.5, 0.5, 0}, 1e6f, {{1, 0, 0}, {}});
  Model model = build.take();
  double fastest = 0;
  bool finite = true;
  try {
    for (int i = 0; i < stepsFor(2, kDt); ++i) {
      model.world.step(static_cast<float>(kDt));
      fastest = std::max(fastest, speedMax(model.world));
    }
  } catch (const NonFiniteError&) {
    finite = false;
  }
  return {holds("finite", finite && isFinite(model.world)),
          atMost("speed_max", fastest, 3, "m/s"),
          within("heavy_speed", model.world.velocity(heavy).linear.x, 1, 0.001, "m/s"),
          {"pushed", "", model.world.pose(model.bodies[2].id).position.x, 0.5, 2, "m"}};
}

}  // namespace

std::vector<Line> collisionLines() {
  return {
      {"R", "momentum", conserve, ""},
      {"R", "deep_overlap", deepOverlap, ""},
      {"R", "million_to_one", millionToOne, ""},
  };
}

}  // namespace avbd::scenes
