// Towers whose load is far heavier than what carries it, and the ordinary tower and pyramid.
#include <algorithm>
#include <cmath>
#include <memory>

#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

constexpr Box kUnit{0.5f, 0.5f, 0.5f};

// The last body is the load: it stands while it never sinks by 1 m or leaves its place by 0.5 m sideways.
Watch watchLoad(double startHeight) {
  Watch watch;
  watch.penetration = true;
  watch.observe = [startHeight](Evidence& e, const Layout&, std::span<const Pose> poses, int) {
    const Vec3d p = poses.back().position;
    const bool up = p.y >= startHeight - 1 && std::abs(p.x) <= 0.5 && std::abs(p.z) <= 0.5;
    double& stands = e.own.try_emplace("stands", 1).first->second;
    if (!up) stands = 0;
  };
  return watch;
}

std::vector<Figure> checkLoad(const Evidence& e) {
  const auto stands = e.own.find("stands");
  return {holds("stands", stands != e.own.end() && stands->second == 1 && e.finite),
          atMost("penetration_peak", e.penetrationPeak, 0.020, "m"),
          atMost("penetration_last_second", e.penetrationLate, 0.005, "m")};
}

std::vector<Figure> checkTower(const Evidence& e) {
  return {atMost("penetration_max", e.penetration.max, 0.004, "m"),
          atMost("horizontal", e.displacement.horizontal, 0.010, "m"), holds("finite", e.finite)};
}

std::vector<Figure> checkHouse(const Evidence& e) {
  return {atMost("displacement", e.displacement.total, 0.1, "m"), holds("finite", e.finite)};
}

Model doubling(const Settings& settings) {
  Build build("doubling", settings);
  build.ground();
  for (int i = 0; i < 10; ++i)
    build.box("box_" + std::to_string(i), kUnit, {0, 0.5 + i, 0}, static_cast<float>(1 << i));
  return build.take();
}

Model tonnes(const Settings& settings) {
  Build build("tonnes", settings);
  build.ground();
  build.box("light", {1, 1, 1}, {0, 1, 0}, 80);
  build.box("heavy", {1, 1, 1}, {0, 3, 0}, 80000);
  return build.take();
}

Scene loaded(std::string name, std::string alias, std::string description, std::function<Model(const Settings&)> make,
             double startHeight) {
  return {std::move(name),        std::move(alias), std::move(description), std::move(make), 0, 600,
          watchLoad(startHeight), checkLoad};
}

}  // namespace

Model heavyOnLight(const Settings& settings, float mass, Scale scale) {
  const float l = scale.length;
  WorldDef def;
  def.gravity = {0, -kGravity * l, 0};
  def.lengthUnit = l;
  def.maxDepenetrationSpeed *= l;
  def.restitutionThreshold *= l;
  Build build("heavy_on_light", settings, def);
  build.fixedBox("ground", {100 * l, l, 100 * l}, {0, -l, 0});
  const Box half{0.5f * l, 0.5f * l, 0.5f * l};
  for (int i = 0; i < 10; ++i) build.box("box_" + std::to_string(i), half, {0, (0.5 + i) * l, 0}, scale.mass);
  build.box("heavy", half, {0, 10.5 * l, 0}, mass * scale.mass);
  return build.take();
}

Model tower10(const Settings& settings, Scale scale) {
  const float l = scale.length;
  WorldDef def;
  def.gravity = {0, -kGravity * l, 0};
  def.lengthUnit = l;
  def.maxDepenetrationSpeed *= l;
  def.restitutionThreshold *= l;
  Build build("tower10", settings, def);
  build.fixedBox("ground", {100 * l, l, 100 * l}, {0, -l, 0});
  for (int i = 0; i < 10; ++i)
    build.box("box_" + std::to_string(i), {l, l, l}, {0, (1.0 + 2 * i) * l, 0}, 80 * scale.mass);
  return build.take();
}

Model pyramid10(const Settings& settings) {
  Build build("pyramid10", settings);
  build.friction(0.5f);
  build.ground();
  for (int r = 0; r < 10; ++r) {
    const int n = 10 - r;
    for (int i = 0; i < n; ++i)
      build.box("box_" + std::to_string(r) + "_" + std::to_string(i), {2, 2, 2},
                {(i - (n - 1) / 2.0) * 4, 2.0 + 4 * r, 0}, 640);
  }
  return build.take();
}

std::vector<Scene> stackScenes() {
  const auto heavy = [](float mass) { return [mass](const Settings& s) { return heavyOnLight(s, mass); }; };
  return {
      loaded("heavy_on_light", "e", "1000 kg on a stack of ten 1 kg boxes", heavy(1000), 10.5),
      loaded("heavy_on_light_10t", "", "10,000 kg on a stack of ten 1 kg boxes", heavy(10000), 10.5),
      loaded("doubling", "", "ten boxes of 1, 2, 4 ... 512 kg, the lightest below", doubling, 9.5),
      loaded("tonnes", "", "80,000 kg on 80 kg", tonnes, 3),
      {"tower10", "", "ten boxes of 2 m", [](const Settings& s) { return tower10(s); }, 0, 600, {}, checkTower},
      {"pyramid10", "", "pyramid of ten rows of 4 m boxes", pyramid10, 0, 600, {}, checkTower},
      {"card_house",
       "",
       "five storeys of leaning cards",
       [](const Settings& s) { return cardHouse(s, 1); },
       0,
       600,
       {},
       checkHouse},
  };
}

}  // namespace avbd::scenes
