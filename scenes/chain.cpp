// Chains of ball joints with a heavy end.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

constexpr double kChainLength = 25;
constexpr double kPi = 3.14159265358979323846;

Model chain(const Settings& settings, float mass) {
  Build build("chain", settings);
  build.filter(kGhost);
  const Quat alongX = turned({0, 0, 1}, -kPi / 2);
  std::vector<BodyId> links;
  for (int i = 0; i < 50; ++i) {
    BodyDef def;
    def.position = {0.25 + 0.5 * i, 40, 0};
    def.rotation = alongX;
    def.shape = Capsule{0.1f, 0.15f};
    def.mass = 1;
    links.push_back(build.add("link_" + std::to_string(i), def));
  }
  links.push_back(build.ball("ball", 1, {26, 40, 0}, mass));
  for (int i = 0; i <= 50; ++i)
    build.joint(i ? links[static_cast<size_t>(i) - 1] : BodyId{}, links[static_cast<size_t>(i)], {0.5 * i, 40, 0});
  return build.take();
}

// Three boxes under each other from a fixed point; the last one starts sideways so that the chain works.
Model hanging(const Settings& settings) {
  Build build("hanging", settings);
  build.filter(kGhost);
  const float masses[3] = {1, 1, 1000};
  BodyId previous;
  for (int i = 0; i < 3; ++i) {
    const BodyId body = build.box("box_" + std::to_string(i), {0.25f, 0.5f, 0.25f}, {0, 9.5 - i, 0}, masses[i],
                                  {{i == 2 ? 1.0f : 0.0f, 0, 0}, {}});
    build.joint(previous, body, {0, 10.0 - i, 0});
    previous = body;
  }
  return build.take();
}

Watch watchChain() {
  Watch watch;
  watch.gap = true;
  watch.observe = [](Evidence& e, const Layout&, std::span<const Pose> poses, int left) {
    if (left >= 300) return;
    const Pose& ball = poses.back();
    const Vec3d anchor = ball.position + rotate(ball.rotation, Vec3d{-1, 0, 0});
    const double stretch = length(anchor - Vec3d{0, 40, 0}) - kChainLength;
    double& worst = e.own.try_emplace("stretch", stretch).first->second;
    if (!(stretch <= worst)) worst = stretch;
  };
  return watch;
}

std::vector<Figure> checkChain(const Evidence& e) {
  const auto stretch = e.own.find("stretch");
  const double relative = stretch == e.own.end() ? NAN : stretch->second / kChainLength;
  return {
      atMost("gap", e.gapLate, 0.001, "m"), {"stretch", "", relative, -1, 0.001, "of 25 m"}, holds("finite", e.finite)};
}

std::vector<Figure> checkHanging(const Evidence& e) {
  return {atMost("gap", e.gapPeak, 0.0005, "m"), holds("finite", e.finite)};
}

}  // namespace

std::vector<Scene> chainScenes() {
  const auto make = [](float mass) { return [mass](const Settings& s) { return chain(s, mass); }; };
  Watch gaps;
  gaps.gap = true;
  return {
      {"chain", "d", "1000 kg on a chain of fifty 1 kg links", make(1000), 0, 600, watchChain(), checkChain},
      {"chain_50t", "", "50,000 kg on a chain of fifty 1 kg links", make(50000), 0, 600, watchChain(), checkChain},
      {"hanging", "", "1, 1 and 1000 kg under each other", hanging, 0, 300, gaps, checkHanging},
  };
}

}  // namespace avbd::scenes
