// Acceptance, scales: masses and lengths times powers of two, step sizes.
#include <bit>
#include <cmath>
#include <cstdint>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

bool same(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }
bool same(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

// Bodies whose pose or velocity differs in a bit after exact scaling of lengths by a power of two.
int bodiesApart(const Model& a, const Model& b, double length) {
  int apart = 0;
  for (size_t i = 0; i < a.bodies.size(); ++i) {
    const Pose p = a.world.pose(a.bodies[i].id), q = b.world.pose(b.bodies[i].id);
    const Velocity v = a.world.velocity(a.bodies[i].id), w = b.world.velocity(b.bodies[i].id);
    const float l = static_cast<float>(length);
    const bool equal =
        same(p.position.x * length, q.position.x) && same(p.position.y * length, q.position.y) &&
        same(p.position.z * length, q.position.z) && same(p.rotation.w, q.rotation.w) &&
        same(p.rotation.x, q.rotation.x) && same(p.rotation.y, q.rotation.y) && same(p.rotation.z, q.rotation.z) &&
        same(v.linear.x * l, w.linear.x) && same(v.linear.y * l, w.linear.y) && same(v.linear.z * l, w.linear.z) &&
        same(v.angular.x, w.angular.x) && same(v.angular.y, w.angular.y) && same(v.angular.z, w.angular.z);
    if (!equal) ++apart;
  }
  return apart;
}

using Make = std::function<Model(const Settings&, Scale)>;

struct Subject {
  const char* name;
  Make make;
  int steps;
};

std::vector<Subject> subjects() {
  return {{"tower10", [](const Settings& s, Scale k) { return tower10(s, k); }, 600},
          {"heavy_on_light", [](const Settings& s, Scale k) { return heavyOnLight(s, 1000, k); }, 600},
          {"slide",
           [](const Settings& s, Scale k) {
             return slidingBox(s, 0.5f, {5, 0, 0}, k);
           },
           120}};
}

// Runs both side by side; the figure is the number of bodies that differ, its params tell the first step.
std::vector<Figure> compare(const Settings& settings, bool scaleLength) {
  std::vector<Figure> figures;
  for (const Subject& subject : subjects())
    for (const float factor : {1.0f / 128, 128.0f}) {
      Model plain = subject.make(settings, {});
      Model scaled = subject.make(settings, scaleLength ? Scale{factor, 1} : Scale{1, factor});
      int apart = 0;
      for (int i = 0; i < subject.steps && apart == 0; ++i) {
        plain.world.step(static_cast<float>(kDt));
        scaled.world.step(static_cast<float>(kDt));
        apart = bodiesApart(plain, scaled, scaleLength ? factor : 1);
      }
      figures.push_back(
          atMost("bodies_apart", apart, 0, "bodies", std::string("scene=") + subject.name + " factor=" + text(factor)));
    }
  return figures;
}

std::vector<Figure> stepSize(const Settings& settings) {
  std::vector<Figure> figures;
  const auto take = [&](const char* trial, std::vector<Figure> list) {
    for (Figure& f : list) {
      f.params = std::string(trial) + " " + f.params;
      figures.push_back(std::move(f));
    }
  };
  for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240}) {
    for (const float mu : {0.1f, 0.2f, 0.4f, 0.5f, 0.6f, 0.8f, 1.0f}) take("slide", trySlide(settings, mu, dt));
    take("roll", tryRoll(settings, dt));
    for (const float e : {0.3f, 0.6f, 0.9f}) take("bounce", tryBounce(settings, e, dt));
    take("tower10", tryTower(settings, dt));
  }
  return figures;
}

}  // namespace

std::vector<Figure> tryTower(const Settings& settings, double dt) {
  Model model = tower10(settings);
  const Layout layout = layoutOf(model.world);
  Watch watch;
  watch.penetration = true;
  const Evidence e = observeRun(*avbdEngine(model, layout), layout, watch, {0, stepsFor(10, dt), dt});
  const std::string params = "rate=" + text(std::round(1 / dt));
  return {atMost("penetration", e.penetrationLate, 0.004, "m", params),
          atMost("horizontal", e.displacement.horizontal, 0.003, "m", params),
          atMost("speed", speedMax(model.world), 1e-3, "m/s", params), holds("finite", e.finite, params)};
}

std::vector<Line> scaleLines() {
  return {
      {"R", "scale_mass", [](const Settings& s) { return compare(s, false); }, ""},
      {"R", "scale_length", [](const Settings& s) { return compare(s, true); }, ""},
      {"R", "step_size", stepSize, ""},
  };
}

}  // namespace avbd::scenes
