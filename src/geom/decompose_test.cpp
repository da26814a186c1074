// Convex decomposition: how many hulls, and whether the error holds for points sampled on both sides, by code of its
// own.
#include <avbd/decompose.h>
#include <avbd/error.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "geom/decompose_cases.h"
#include "geom/decompose_measure.h"
#include "geom/hull_math.h"

namespace avbd {
namespace {

DecomposeDef defOf(const TestMesh& mesh) {
  return {.vertices = mesh.vertices, .triangles = mesh.triangles, .resolution = 32};
}

/// Volume by signed tetrahedra.
double volumeOf(const TestMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = toDouble(mesh.vertices[t[0]]), b = toDouble(mesh.vertices[t[1]]), c = toDouble(mesh.vertices[t[2]]);
    sum += dot(a, cross(b, c)) / 6;
  }
  return sum;
}

/// Crossings of a slanted ray: odd inside.
bool insideMesh(const TestMesh& mesh, Vec3d p) {
  const Vec3d d{0.5773, 0.31415, 0.7531};
  int crossings = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = toDouble(mesh.vertices[t[0]]) - p, b = toDouble(mesh.vertices[t[1]]) - p,
                c = toDouble(mesh.vertices[t[2]]) - p;
    const double u = dot(d, cross(a, b)), v = dot(d, cross(b, c)), w = dot(d, cross(c, a));
    if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
    const Vec3d n = cross(b - a, c - a);
    crossings += dot(a, n) / dot(d, n) > 0;
  }
  return crossings % 2 == 1;
}

double distanceToMesh(const TestMesh& mesh, Vec3d p) {
  if (insideMesh(mesh, p)) return 0;
  double least = 1e300;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = toDouble(mesh.vertices[t[0]]), b = toDouble(mesh.vertices[t[1]]), c = toDouble(mesh.vertices[t[2]]);
    // Within the triangle's prism: the plane. Else its sides.
    const Vec3d n = normalized(cross(b - a, c - a));
    const bool within =
        dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
    if (within) least = std::min(least, std::fabs(dot(n, p - a)));
    for (const auto& [s, e] : {std::pair{a, b}, {b, c}, {c, a}}) {
      const Vec3d side = e - s;
      const double along = std::clamp(dot(p - s, side) / dot(side, side), 0.0, 1.0);
      least = std::min(least, length(p - s - side * along));
    }
  }
  return least;
}

bool insideHull(const HullData& hull, Vec3d p) {
  return std::ranges::all_of(hull.faces(),
                             [&](const HullData::Face& f) { return dot(toDouble(f.normal), p) <= f.offset; });
}

double distanceToHulls(const Decomposition& d, Vec3d p) {
  double least = 1e300;
  for (const auto& hull : d.hulls) {
    if (insideHull(*hull, p)) return 0;
    std::vector<Vec3d> corners;
    for (const Vec3& v : hull->vertices()) corners.push_back(toDouble(v));
    least = std::min(least, length(p - nearestInHull(p, corners)));
  }
  return least;
}

/// Samples hulls and solid; returns the largest distances found.
struct Sampled {
  double out = 0;   ///< of hulls' points from the solid
  double left = 0;  ///< of the solid's points from the hulls
  double unionVolume = 0;
};

Sampled sample(const TestMesh& mesh, const Decomposition& d, int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  Sampled s;
  for (const auto& hull : d.hulls) {
    const Vec3d low = toDouble(hull->lower()), size = toDouble(hull->upper()) - low;
    for (int i = 0; i < count; ++i) {
      const Vec3d p = low + Vec3d{unit(random) * size.x, unit(random) * size.y, unit(random) * size.z};
      if (insideHull(*hull, p)) s.out = std::max(s.out, distanceToMesh(mesh, p));
    }
    // Corners and points on faces are the most likely to stick out.
    for (const Vec3& v : hull->vertices()) s.out = std::max(s.out, distanceToMesh(mesh, toDouble(v) * (1 - 1e-9)));
    for (const HullData::Face& f : hull->faces()) {
      Vec3d middle;
      for (int i = 0; i < f.count; ++i)
        middle = middle + toDouble(hull->vertices()[hull->loops()[f.first + i]]) * (1.0 / f.count);
      s.out = std::max(s.out, distanceToMesh(mesh, middle));
    }
  }
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    s.left = std::max(s.left, distanceToHulls(d, toDouble(v)));
  }
  const Vec3d size = toDouble(high - low);
  int within = 0, total = 20 * count;
  for (int i = 0; i < total; ++i) {
    const Vec3d p = toDouble(low) + Vec3d{unit(random) * size.x, unit(random) * size.y, unit(random) * size.z};
    const double distance = distanceToHulls(d, p);
    within += distance == 0;
    if (distance > s.left && insideMesh(mesh, p)) s.left = distance;
  }
  s.unionVolume = size.x * size.y * size.z * within / total;
  return s;
}

void expectGood(const TestMesh& mesh, const Decomposition& d, float maxError) {
  EXPECT_LE(d.error, maxError);
  EXPECT_LE(d.errorFound, d.error);
  EXPECT_NEAR(d.volume, volumeOf(mesh), 1e-5 * volumeOf(mesh));
  const Sampled s = sample(mesh, d, 400);
  EXPECT_LE(s.out, d.error + 1e-6);
  EXPECT_LE(s.left, d.error + 1e-6);
  // The union holds the solid but for simplification, and is not much larger.
  EXPECT_GT(s.unionVolume, 0.95 * volumeOf(mesh));
  EXPECT_LT(s.unionVolume, 1.25 * volumeOf(mesh));
}

TEST(Decompose, tetrahedronIsOneHull) {
  const TestMesh mesh = tetrahedronMesh();
  const Decomposition d = decompose(defOf(mesh));
  ASSERT_EQ(d.hulls.size(), 1u);
  EXPECT_EQ(d.hulls[0]->vertices().size(), 4u);
  EXPECT_LT(d.errorFound, 1e-6);
  expectGood(mesh, d, 0.02f);
}

TEST(Decompose, lIsTwoHulls) {
  const TestMesh mesh = lMesh();
  const Decomposition d = decompose(defOf(mesh));
  EXPECT_EQ(d.hulls.size(), 2u);
  EXPECT_LT(d.errorFound, 1e-6);
  expectGood(mesh, d, 0.02f);
}

TEST(Decompose, twoBoxesAreTwoHulls) {
  TestMesh mesh = boxMesh({0.2f, 0.3f, 0.4f});
  mesh.add(boxMesh({0.3f, 0.1f, 0.2f}), {1, 0.1f, 0});
  const Decomposition d = decompose(defOf(mesh));
  ASSERT_EQ(d.hulls.size(), 2u);
  EXPECT_EQ(d.hulls[0]->vertices().size(), 8u);
  EXPECT_EQ(d.hulls[1]->vertices().size(), 8u);
  EXPECT_LT(d.errorFound, 1e-6);
  expectGood(mesh, d, 0.03f);
}

TEST(Decompose, torus) {
  const TestMesh mesh = torusMesh(1, 0.3f, 32, 16);
  DecomposeDef def = defOf(mesh);
  def.maxError = 0.08f;
  const Decomposition d = decompose(def);
  EXPECT_GE(d.hulls.size(), 5u);
  EXPECT_LE(d.hulls.size(), 24u);
  expectGood(mesh, d, 0.08f);
}

TEST(Decompose, bowl) {
  const TestMesh mesh = bowlMesh();
  DecomposeDef def = defOf(mesh);
  def.maxError = 0.15f;
  const Decomposition d = decompose(def);
  EXPECT_LE(d.errorFound, d.error);
  const Sampled s = sample(mesh, d, 200);
  EXPECT_LE(s.out, d.error + 1e-6);
  EXPECT_LE(s.left, d.error + 1e-6);
  EXPECT_LE(d.error, 0.15f);
  // A ball stays out of the bowl's middle.
  EXPECT_GT(distanceToHulls(d, {0, -0.3, 0}), 0.4);
}

TEST(Decompose, fewHullsSayWhatTheyCost) {
  const TestMesh mesh = torusMesh(1, 0.3f, 24, 12);
  DecomposeDef def = defOf(mesh);
  def.maxHulls = 1;
  def.resolution = 24;
  const Decomposition one = decompose(def);
  ASSERT_EQ(one.hulls.size(), 1u);
  // The middle of the hole is 0.7 from the solid.
  EXPECT_GT(one.errorFound, 0.65);
  EXPECT_GE(one.error, one.errorFound);
  EXPECT_LT(one.error, 0.75);
  def.maxHulls = 4;
  const Decomposition four = decompose(def);
  EXPECT_LE(four.hulls.size(), 4u);
  EXPECT_LT(four.error, one.error);
}

/// What cannot be told apart within the resolution is not looked for without end.
TEST(Decompose, aTinyErrorTakesNoLonger) {
  const TestMesh box = boxMesh({0.5f, 0.5f, 0.5f}), ell = lMesh();
  for (float maxError : {1e-5f, 1e-40f}) {
    DecomposeDef def = defOf(box);
    def.resolution = 64;
    def.maxError = maxError;
    const Decomposition one = decompose(def);
    EXPECT_EQ(one.hulls.size(), 1u) << maxError;
    EXPECT_LT(one.errorFound, 1e-6) << maxError;
    EXPECT_LE(one.error, 0.5f / 64) << maxError;
    def.vertices = ell.vertices;
    def.triangles = ell.triangles;
    const Decomposition two = decompose(def);
    EXPECT_EQ(two.hulls.size(), 2u) << maxError;
    EXPECT_LT(two.errorFound, 1e-6) << maxError;
  }
}

TEST(Decompose, aThousandShells) {
  TestMesh mesh;
  const TestMesh bolt = boxMesh({0.2f, 0.15f, 0.3f});
  for (int i = 0; i < 1000; ++i)
    mesh.add(bolt, {static_cast<float>(i % 10), static_cast<float>(i / 10 % 10), static_cast<float>(i / 100)});
  DecomposeDef def = defOf(mesh);
  def.resolution = 64;
  def.maxHulls = 1024;
  const Decomposition all = decompose(def);
  EXPECT_EQ(all.hulls.size(), 1000u);
  EXPECT_LT(all.errorFound, 1e-6);
  def.maxHulls = 32;
  const Decomposition few = decompose(def);
  EXPECT_LE(few.hulls.size(), 32u);
  EXPECT_GT(few.errorFound, 0.2);
  EXPECT_LE(few.errorFound, few.error);
}

/// A unit cube, and hulls that leave known parts of it out.
TEST(Decompose, whatHullsLeaveOutIsMeasured) {
  const TestMesh mesh = boxMesh({0.5f, 0.5f, 0.5f});
  const ClosedSurface surface(mesh.vertices, mesh.triangles);
  const VoxelGrid grid(surface, 32, false);
  const Solid3 solid{surface, grid};
  using Hulls = std::vector<std::shared_ptr<const HullData>>;
  const auto boxHull = [](Vec3 low, Vec3 high) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i)
      points.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    return makeHull({.points = points});
  };
  const auto expectLeft = [&](const Hulls& hulls, double wanted) {
    const Reach left = leftOutside(hulls, solid, 0, 0.01);
    EXPECT_LE(left.found, wanted + 1e-6);
    EXPECT_GE(left.bound, wanted - 1e-6);
    EXPECT_LE(left.bound, left.found + 0.010001);
    EXPECT_EQ(leftOutside(hulls, solid, wanted + 0.02, 0.01).bound, wanted + 0.02);
  };
  const Vec3 low{-0.5f, -0.5f, -0.5f}, high{0.5f, 0.5f, 0.5f};
  expectLeft({boxHull(low, high)}, 0);
  expectLeft({boxHull(low, {0.3f, 0.5f, 0.5f})}, 0.2);
  // A gap in the middle, and one corner of an eighth: its own corner is farthest from the three other sides.
  expectLeft({boxHull(low, {-0.1f, 0.5f, 0.5f}), boxHull({0.1f, -0.5f, -0.5f}, high)}, 0.1);
  expectLeft({boxHull(low, {0, 0.5f, 0.5f}), boxHull({0, -0.5f, -0.5f}, {0.5f, 0, 0.5f}),
              boxHull({0, 0, -0.5f}, {0.5f, 0.5f, 0})},
             0.5);
}

TEST(Decompose, sameResultFromAnotherOrder) {
  TestMesh mesh = lMesh();
  const Decomposition a = decompose(defOf(mesh));
  std::mt19937 random(5);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  for (auto& t : mesh.triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
  const Decomposition b = decompose(defOf(mesh));
  ASSERT_EQ(a.hulls.size(), b.hulls.size());
  for (size_t i = 0; i < a.hulls.size(); ++i) EXPECT_EQ(a.hulls[i]->contentHash(), b.hulls[i]->contentHash());
  EXPECT_EQ(a.error, b.error);
}

TEST(Decompose, openSurfaces) {
  TestMesh mesh = boxMesh({0.5f, 0.5f, 0.5f});
  mesh.triangles.pop_back();
  const auto refuse = [](const DecomposeDef& def, const std::string& field, const std::string& words) {
    try {
      decompose(def);
      FAIL() << "accepted: " << words;
    } catch (const Error& e) {
      EXPECT_EQ(e.definition(), "DecomposeDef");
      EXPECT_EQ(e.field(), field);
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
  };
  refuse(defOf(mesh), "triangles", "3 open edges, first edge (");
  TestMesh turned = boxMesh({0.5f, 0.5f, 0.5f});
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  refuse(defOf(turned), "triangles", "disagree");
  for (auto& t : turned.triangles) std::swap(t[0], t[1]);
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  refuse(defOf(turned), "triangles", "anticlockwise");
  TestMesh bad = boxMesh({0.5f, 0.5f, 0.5f});
  bad.triangles[3][1] = 8;
  refuse(defOf(bad), "triangles[3]", "8");
  bad = boxMesh({0.5f, 0.5f, 0.5f});
  bad.vertices[2].z = NAN;
  refuse(defOf(bad), "vertices[2]", "nan");
  refuse(DecomposeDef{}, "triangles", "must have area");
  DecomposeDef def = defOf(mesh);
  def.resolution = 7;
  refuse(def, "resolution", "7");
  def = defOf(mesh);
  def.maxHulls = 0;
  refuse(def, "maxHulls", "0");
  def = defOf(mesh);
  def.maxError = -1;
  refuse(def, "maxError", "-1");
}

TEST(Decompose, sealClosesGapsBelowAVoxel) {
  // Two halves of a box that do not quite meet, each without the sides between them.
  TestMesh mesh = boxMesh({0.5f, 0.5f, 0.5f});
  TestMesh slit;
  for (const auto& t : mesh.triangles) {
    const uint32_t first = static_cast<uint32_t>(slit.vertices.size());
    Vec3 middle;
    for (uint32_t v : t) middle = middle + mesh.vertices[v] * (1.0f / 3);
    for (uint32_t v : t) slit.vertices.push_back(mesh.vertices[v] + (middle - mesh.vertices[v]) * 0.004f);
    slit.triangles.push_back({first, first + 1, first + 2});
  }
  DecomposeDef def = defOf(slit);
  EXPECT_THROW(decompose(def), Error);
  def.seal = true;
  def.resolution = 32;
  const Decomposition d = decompose(def);
  EXPECT_EQ(d.openEdges, 36u);
  ASSERT_EQ(d.hulls.size(), 1u);
  EXPECT_NEAR(d.hulls[0]->massProperties(1).mass, 1, 0.02);
  EXPECT_NEAR(d.volume, 1, 0.1);
}

}  // namespace
}  // namespace avbd
