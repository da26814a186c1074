// Nets of ball joints that catch a heavy ball.
#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

constexpr Filter kNode{.category = 2, .mask = 1, .group = 0, .anyMask = false};
constexpr Filter kBall{.category = 1, .mask = 2, .group = 0, .anyMask = false};

Model net(const Settings& settings) {
  Build build("net", settings);
  build.filter(kNode);
  BodyId node[20][20];
  const auto at = [](int i, int j) { return Vec3d{(i - 9.5) * 0.25, 10, (j - 9.5) * 0.25}; };
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      node[i][j] = build.ball("node_" + std::to_string(i) + "_" + std::to_string(j), 0.1f, at(i, j), 0.1f);
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const Vec3d p = at(i, j);
      if (i + 1 < 20) build.joint(node[i][j], node[i + 1][j], {p.x + 0.125, p.y, p.z});
      if (j + 1 < 20) build.joint(node[i][j], node[i][j + 1], {p.x, p.y, p.z + 0.125});
    }
  for (const int i : {0, 19})
    for (const int j : {0, 19}) build.joint({}, node[i][j], at(i, j));
  build.filter(kBall);
  build.ball("ball", 0.5f, {0, 15, 0}, 100);
  return build.take();
}

constexpr int kMail = 30;
constexpr double kMailSpacing = 0.65;

Vec3d mailAt(int i, int j) {
  return {(i - (kMail - 1) / 2.0) * kMailSpacing, 35, (j - (kMail - 1) / 2.0) * kMailSpacing};
}

// A node carries the capsules of the edges towards larger i and j; they weigh nothing.
BodyId mailNode(Build& build, int i, int j) {
  constexpr double kHalfPi = 1.57079632679489661923;
  BodyDef def;
  const bool corner = (i == 0 || i == kMail - 1) && (j == 0 || j == kMail - 1);
  def.type = corner ? BodyType::Static : BodyType::Dynamic;
  def.position = mailAt(i, j);
  def.angularDamping = 0.5f;
  ShapeDef shape;
  shape.material.friction = 0.5f;
  shape.filter = kNode;
  shape.geometry = Sphere{0.12f};
  def.shapes.push_back(shape);
  shape.geometry = Capsule{0.06f, 0.265f};
  if (i + 1 < kMail) {
    shape.pose = {{kMailSpacing / 2, 0, 0}, turned({0, 0, 1}, -kHalfPi)};
    def.shapes.push_back(shape);
  }
  if (j + 1 < kMail) {
    shape.pose = {{0, 0, kMailSpacing / 2}, turned({1, 0, 0}, kHalfPi)};
    def.shapes.push_back(shape);
  }
  if (!corner) {
    constexpr float kMass = 0.0217f, kInertia = 0.4f * kMass * 0.12f * 0.12f;
    def.massProperties = MassProperties{kMass, {}, {kInertia, kInertia, kInertia, 0, 0, 0}};
  }
  return build.add("node_" + std::to_string(i) + "_" + std::to_string(j), def);
}

Model chainmail(const Settings& settings) {
  Build build("chainmail", settings);
  build.friction(0.5f);
  std::vector<BodyId> node;
  for (int i = 0; i < kMail; ++i)
    for (int j = 0; j < kMail; ++j) node.push_back(mailNode(build, i, j));
  const auto get = [&](int i, int j) { return node[static_cast<size_t>(i * kMail + j)]; };
  for (int i = 0; i < kMail; ++i)
    for (int j = 0; j < kMail; ++j) {
      const Vec3d p = mailAt(i, j);
      if (i + 1 < kMail) build.joint(get(i, j), get(i + 1, j), {p.x + kMailSpacing / 2, p.y, p.z});
      if (j + 1 < kMail) build.joint(get(i, j), get(i, j + 1), {p.x, p.y, p.z + kMailSpacing / 2});
    }
  build.filter(kBall);
  build.ball("ball", 2, {0, 70, 0}, 10053);
  return build.take();
}

// The ball is the last body; it is through where it is lower than the lowest node by more than `margin`.
Watch watchNet(double margin) {
  Watch watch;
  watch.gap = true;
  watch.observe = [margin](Evidence& e, const Layout&, std::span<const Pose> poses, int) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Pose& p : poses.first(poses.size() - 1)) lowest = std::min(lowest, p.position.y);
    double& caught = e.own.try_emplace("caught", 1).first->second;
    if (!(poses.back().position.y >= lowest - margin)) caught = 0;
  };
  return watch;
}

std::vector<Figure> checkNet(const Evidence& e, const char* word, double gap) {
  const auto caught = e.own.find("caught");
  return {holds(word, caught != e.own.end() && caught->second == 1 && e.finite), atMost("gap", e.gapPeak, gap, "m")};
}

}  // namespace

std::vector<Scene> netScenes() {
  return {
      {"net", "f", "net of 400 nodes hit by a 100 kg ball", net, 0, 600, watchNet(0.4),
       [](const Evidence& e) { return checkNet(e, "holds", 0.040); }},
      {"chainmail", "", "net of 900 nodes hit by a ten-tonne ball", chainmail, 0, 600, watchNet(2),
       [](const Evidence& e) { return checkNet(e, "caught", 0.100); }},
  };
}

}  // namespace avbd::scenes
