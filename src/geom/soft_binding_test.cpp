// Fine points that follow a cage: which element holds them, and where its motion takes them.
#include <avbd/error.h>
#include <avbd/soft_binding.h>
#include <avbd/soft_lattice.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "geom/decompose_cases.h"

namespace avbd {
namespace {

/// A point's place under x -> A x + t.
struct Affine {
  std::array<Vec3d, 3> rows;
  Vec3d t;
  Vec3d operator()(Vec3d p) const { return Vec3d{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)} + t; }
};

constexpr Affine kSheared = {{{{1.2, 0.3, -0.1}, {0.2, 0.7, 0.4}, {-0.5, 0.1, 1.1}}}, {3000, -20, 0.125}};
constexpr Affine kTurned = {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}}, {0, 5, 0}};

std::vector<Vec3d> moved(std::span<const Vec3> points, const Affine& map) {
  std::vector<Vec3d> out;
  for (const Vec3 p : points) out.push_back(map(toDouble(p)));
  return out;
}

/// How far the skin is from where a map of all space takes the fine points.
double errorOf(const SurfaceBinding& binding, const SoftMeshData& mesh, std::span<const Vec3> fine, const Affine& map) {
  std::vector<Vec3d> out(fine.size());
  binding.skin(moved(mesh.points(), map), out);
  double worst = 0;
  for (size_t i = 0; i < fine.size(); ++i) worst = std::fmax(worst, length(out[i] - map(toDouble(fine[i]))));
  return worst;
}

std::vector<Vec3> cloud(size_t count, float reach) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-reach, reach);
  std::vector<Vec3> points;
  while (points.size() < count) points.push_back({unit(random), unit(random), unit(random)});
  return points;
}

TEST(SurfaceBinding, WhatCannotBeBoundIsRefusedByName) {
  const auto box = makeTetBox({1, 1, 1}, 1, 1, 1);
  const auto complaint = [](const SurfaceBindingDef& def) -> std::string {
    try {
      SurfaceBinding binding(def);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  std::vector<Vec3> points = {{0, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}};
  EXPECT_EQ(complaint({nullptr, points}), "SurfaceBindingDef.mesh = null: must be a soft mesh");
  EXPECT_EQ(complaint({box, {}}), "SurfaceBindingDef.points = none: must have at least one");
  EXPECT_EQ(complaint({box, points}), "SurfaceBindingDef.points[1] = (0, inf, 0): must be finite and within +-1e+06");
  points.pop_back();
  const SurfaceBinding binding({box, points});
  std::vector<Vec3d> cage(8), out(1), more(2);
  binding.skin(cage, out);
  EXPECT_THROW(binding.skin(more, out), Error);
  EXPECT_THROW(binding.skin(cage, more), Error);
}

TEST(SurfaceBinding, PointsBindToTetrahedraThatHoldThem) {
  const auto box = makeTetBox({1, 1, 1}, 3, 4, 5);
  const std::vector<Vec3> points = cloud(2000, 1);
  const SurfaceBinding binding({box, points});
  EXPECT_EQ(binding.outside(), 0u);
  EXPECT_EQ(binding.farthest(), 0);
  for (size_t i = 0; i < points.size(); ++i) {
    const BoundPoint& p = binding.points()[i];
    EXPECT_EQ(p.corners, box->tets()[p.element]);
    double sum = 0;
    for (const double w : p.weights) {
      EXPECT_GE(w, 0);
      sum += w;
    }
    EXPECT_NEAR(sum, 1, 1e-15);
  }
  EXPECT_LE(errorOf(binding, *box, points, kSheared), 1e-11);
}

TEST(SurfaceBinding, PointsOutsideFollowTheNearestTetrahedron) {
  const auto box = makeTetBox({1, 1, 1}, 3, 3, 3);
  const std::vector<Vec3> points = cloud(2000, 2);
  const SurfaceBinding binding({box, points});
  uint32_t outside = 0;
  double farthest = 0;
  for (const Vec3& p : points) {
    const double x = std::fmax(0, std::fabs(double{p.x}) - 1), y = std::fmax(0, std::fabs(double{p.y}) - 1),
                 z = std::fmax(0, std::fabs(double{p.z}) - 1);
    outside += x + y + z > 0;
    farthest = std::fmax(farthest, std::sqrt(x * x + y * y + z * z));
  }
  EXPECT_EQ(binding.outside(), outside);
  EXPECT_NEAR(binding.farthest(), farthest, 1e-12);
  EXPECT_LE(errorOf(binding, *box, points, kSheared), 1e-10);
}

TEST(SurfaceBinding, ALatticeCarriesTheSurfaceThatItWasMadeOf) {
  const TestMesh torus = torusMesh(0.5f, 0.2f, 48, 24);
  for (const LatticeFit fit : {LatticeFit::Surface, LatticeFit::Cover}) {
    const auto mesh =
        makeTetLattice({.points = torus.vertices, .triangles = torus.triangles, .cellSize = 0.1f, .fit = fit});
    const SurfaceBinding binding({mesh, torus.vertices});
    EXPECT_LE(binding.farthest(), fit == LatticeFit::Cover ? 0.007 : 0.02);
    if (fit == LatticeFit::Cover) {
      EXPECT_LE(binding.outside(), torus.vertices.size() / 20);
    }
    EXPECT_LE(errorOf(binding, *mesh, torus.vertices, kSheared), 1e-11);
  }
}

TEST(SurfaceBinding, ClothCarriesPointsBesideIt) {
  const auto cloth = makeClothGrid(1, 1, 7, 5);
  std::vector<Vec3> points = cloud(500, 1);
  const SurfaceBinding binding({cloth, points});
  EXPECT_EQ(binding.outside(), 0u);
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(binding.points()[i].offset, double{points[i].y}, 1e-7);
    for (const double w : binding.points()[i].weights) EXPECT_GE(w, -1e-6);
  }
  EXPECT_LE(errorOf(binding, *cloth, points, kTurned), 1e-12);
  for (Vec3& p : points) p.y = 0;
  EXPECT_LE(errorOf(SurfaceBinding({cloth, points}), *cloth, points, kSheared), 1e-11);
}

TEST(SurfaceBinding, ClothKeepsOffsetsAlongItsNormal) {
  // Stretched to twice its width the cloth is as thick as before.
  const auto cloth = makeClothGrid(1, 1, 2, 2);
  const std::vector<Vec3> points = {{0.3f, 0.25f, 0.1f}};
  const SurfaceBinding binding({cloth, points});
  const Affine wide = {{{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}}, {0, 1, 0}};
  std::vector<Vec3d> out(1);
  binding.skin(moved(cloth->points(), wide), out);
  EXPECT_NEAR(out[0].x, 0.6, 1e-6);
  EXPECT_NEAR(out[0].y, 1.25, 1e-6);
  EXPECT_NEAR(out[0].z, 0.2, 1e-6);
}

TEST(SurfaceBinding, NormalsLookOutside) {
  const TestMesh torus = torusMesh(0.5f, 0.2f, 48, 24);
  std::vector<Vec3d> points;
  for (const Vec3& v : torus.vertices) points.push_back(toDouble(v));
  points.push_back({9, 9, 9});
  std::vector<Vec3> normals(points.size());
  smoothNormals(points, torus.triangles, normals);
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 p = torus.vertices[i];
    const float around = std::sqrt(p.x * p.x + p.z * p.z);
    const Vec3 out = p - Vec3{p.x, 0, p.z} * (0.5f / around);
    EXPECT_GE(dot(normals[i], out) / length(out), 0.99f);
    EXPECT_NEAR(length(normals[i]), 1, 1e-6);
  }
  EXPECT_EQ(normals.back(), (Vec3{0, 1, 0}));
  EXPECT_THROW(smoothNormals(points, torus.triangles, std::span(normals).first(3)), Error);
  const std::vector<std::array<uint32_t, 3>> beyond = {{0, 1, 99999}};
  EXPECT_THROW(smoothNormals(points, beyond, normals), Error);
}

}  // namespace
}  // namespace avbd
