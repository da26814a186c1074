// Time of collide() per pair, for each kind of pair in the states that piles are made of.
#include <avbd/hull.h>
#include <benchmark/benchmark.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "collide/collide.h"

namespace avbd {
namespace {

struct Case {
  ShapeGeom a, b;
  NearPose poseA, poseB;
};

Quat turned(float angle, Vec3 axis) {
  const float s = std::sin(angle / 2) / length(axis);
  return {std::cos(angle / 2), axis.x * s, axis.y * s, axis.z * s};
}

/// Many pairs that differ a little, so that neither branches nor loads are learnt by heart.
std::vector<Case> cases(const Geometry& a, const Geometry& b, Vec3 offset, float spread, float yaw, float tilt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<Case> all;
  for (int i = 0; i < 256; ++i) {
    Case c{toShapeGeom(a), toShapeGeom(b), {}, {}};
    c.poseA.q = turned(0.01f * unit(random) * tilt, {unit(random), 0, unit(random)});
    c.poseB.q = turned(yaw * unit(random), {0, 1, 0}) * turned(tilt * unit(random), {unit(random), 0.1f, unit(random)});
    c.poseB.p = offset + Vec3{spread * unit(random), 0.002f * unit(random), spread * unit(random)};
    all.push_back(c);
  }
  return all;
}

void run(benchmark::State& state, const std::vector<Case>& all) {
  size_t i = 0;
  int64_t points = 0;
  Manifold out;
  for (auto _ : state) {
    const Case& c = all[i++ & 255];
    collide(c.a, c.poseA, c.b, c.poseB, 0.02f, out);
    points += out.count;
    benchmark::DoNotOptimize(out);
  }
  state.counters["points"] = static_cast<double>(points) / static_cast<double>(state.iterations());
}

const Box kBox{0.5f, 0.5f, 0.5f};
const Sphere kSphere{0.5f};
const Capsule kCapsule{0.3f, 0.5f};

#define AVBD_PAIR(name, ...) BENCHMARK_CAPTURE(run, name, cases(__VA_ARGS__))
AVBD_PAIR(sphere_sphere, kSphere, kSphere, {0, 1, 0}, 0.1f, 1, 1);
AVBD_PAIR(sphere_capsule, kSphere, kCapsule, {0, 0.8f, 0}, 0.1f, 1, 1);
AVBD_PAIR(sphere_box, kSphere, kBox, {0, 1, 0}, 0.1f, 1, 0.01f);
AVBD_PAIR(sphere_half_space, kSphere, HalfSpace{}, {0, -0.5f, 0}, 0.1f, 1, 0.01f);
AVBD_PAIR(capsule_capsule_crossed, kCapsule, kCapsule, {0.59f, 0, 0}, 0.05f, 1, 1);
AVBD_PAIR(capsule_capsule_along, kCapsule, kCapsule, {0.6f, 0, 0}, 0.001f, 0, 0.01f);
AVBD_PAIR(capsule_box_upright, kCapsule, kBox, {0, 1.3f, 0}, 0.1f, 1, 0.01f);
AVBD_PAIR(capsule_box_along, kCapsule, kBox, {0.8f, 0, 0}, 0.001f, 0, 0.01f);
AVBD_PAIR(capsule_half_space, kCapsule, HalfSpace{}, {0, -0.8f, 0}, 0.1f, 1, 0.01f);
AVBD_PAIR(box_half_space, kBox, HalfSpace{}, {0, -0.5f, 0}, 0.1f, 1, 0.001f);
AVBD_PAIR(box_box_stacked, kBox, kBox, {0, 1, 0}, 0, 0, 0.0001f);
AVBD_PAIR(box_box_shifted, kBox, kBox, {0, 1, 0}, 0.2f, 0.001f, 0.0001f);
AVBD_PAIR(box_box_turned, kBox, kBox, {0, 1, 0}, 0.1f, 1, 0.001f);
AVBD_PAIR(box_box_on_ground, Box{100, 0.5f, 100}, kBox, {0, 1, 0}, 10, 1, 0.001f);
AVBD_PAIR(box_box_pile, kBox, kBox, {0.3f, 1, 0.2f}, 0.4f, 1, 0.3f);
AVBD_PAIR(box_box_corner_apart, kBox, kBox, {1.01f, 1.01f, 0}, 0.001f, 0, 0.001f);
AVBD_PAIR(box_box_apart, kBox, kBox, {0, 1.2f, 0}, 0.2f, 1, 0.01f);

/// One of every convex type, about half a metre in every direction. The hull has 32 corners on a ball, cut flat below
/// and above; the box hull is a box.
std::vector<std::pair<std::string, Geometry>> everyType() {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  std::vector<Vec3> ball, corners;
  for (int i = 0; i < 24; ++i) {
    const Vec3 p{normal(random), normal(random), normal(random)};
    const float k = 0.6f / length(p);
    ball.push_back({p.x * k, p.y * k > 0.4f ? 0.4f : (p.y * k < -0.4f ? -0.4f : p.y * k), p.z * k});
  }
  for (int k = 0; k < 8; ++k) {
    corners.push_back({k & 1 ? 0.5f : -0.5f, k & 2 ? 0.5f : -0.5f, k & 4 ? 0.5f : -0.5f});
    ball.push_back({k & 1 ? 0.3f : -0.3f, k & 2 ? 0.5f : -0.5f, k & 4 ? 0.3f : -0.3f});
  }
  return {{"sphere", Sphere{0.5f}},
          {"capsule", Capsule{0.25f, 0.25f}},
          {"box", kBox},
          {"cylinder", Cylinder{0.5f, 0.5f}},
          {"cone", Cone{0.5f, 0.5f}},
          {"ellipsoid", Ellipsoid{0.5f, 0.5f, 0.4f}},
          {"rounded_box", Box{0.4f, 0.4f, 0.4f, 0.1f}},
          {"box_hull", Hull{makeHull({.points = corners})}},
          {"hull", Hull{makeHull({.points = ball})}},
          {"half_space", HalfSpace{}}};
}

/// Every pair of the table: one resting on the other, the same with the upper one shifted and turned so that edges and
/// corners touch, and apart by more than the margin.
void registerTable() {
  static const auto types = everyType();  // holds the hulls
  for (size_t i = 0; i < types.size(); ++i) {
    for (size_t j = i; j < types.size(); ++j) {
      if (std::holds_alternative<HalfSpace>(types[i].second)) continue;
      const bool plane = std::holds_alternative<HalfSpace>(types[j].second);
      const float y = plane ? -0.499f : 0.999f;
      const auto add = [&](const char* how, const std::vector<Case>& all) {
        const std::string name = "table/" + types[i].first + "/" + types[j].first + "/" + how;
        benchmark::RegisterBenchmark(name.c_str(), [all](benchmark::State& state) { run(state, all); });
      };
      add("rest", cases(types[i].second, types[j].second, {0, y, 0}, 0.1f, 0.3f, 0.0005f));
      add("shifted", cases(types[i].second, types[j].second, {0.4f, 0.92f * y, 0.3f}, 0.1f, 1, plane ? 0.001f : 0.6f));
      add("apart", cases(types[i].second, types[j].second, {0.3f, plane ? -0.8f : 1.3f, 0.2f}, 0.1f, 1, 0.1f));
    }
  }
}

}  // namespace
}  // namespace avbd

int main(int argc, char** argv) {
  avbd::registerTable();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
