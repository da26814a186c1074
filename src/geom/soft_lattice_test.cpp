// Lattices of solids: what is refused, how near the surface they come, and how good their tetrahedra are.
#include <avbd/error.h>
#include <avbd/soft_lattice.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "geom/decompose_cases.h"
#include "geom/decompose_surface.h"
#include "geom/lattice.h"

namespace avbd {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

std::shared_ptr<const SoftMeshData> latticeOf(const TestMesh& surface, float cell,
                                              LatticeFit fit = LatticeFit::Surface) {
  return makeTetLattice({.points = surface.vertices, .triangles = surface.triangles, .cellSize = cell, .fit = fit});
}

std::string complaint(const TestMesh& surface, float cell) {
  try {
    latticeOf(surface, cell);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

void expectRefused(const TestMesh& surface, float cell, const char* part) {
  const std::string said = complaint(surface, cell);
  EXPECT_NE(said.find(part), std::string::npos) << said;
}

double volumeOf(const TestMesh& m) { return ClosedSurface(m.vertices, m.triangles).volume(); }

TEST(SoftLattice, WhatIsNoSolidIsRefusedByName) {
  const TestMesh box = boxMesh({1, 1, 1});
  expectRefused({box.vertices, {}}, 0.5f, "SoftLatticeDef.triangles = none");
  TestMesh broken = box;
  broken.triangles.pop_back();
  expectRefused(broken, 0.5f, "3 open edges, first edge (-1, -1, 1) to (-1, 1, 1) of 1 triangle");
  broken = box;
  broken.vertices[3].y = std::numeric_limits<float>::quiet_NaN();
  expectRefused(broken, 0.5f, "points[3]");
  broken = box;
  broken.triangles[2][1] = 8;
  expectRefused(broken, 0.5f, "triangles[2] = 8: must be < 8");
  expectRefused(boxMesh({1, 1, 0}), 0.5f, "SoftLatticeDef.triangles");
  TestMesh turned = box;
  for (auto& t : turned.triangles) std::swap(t[0], t[1]);
  expectRefused(turned, 0.5f, "anticlockwise seen from outside");
  // Two boxes that share an edge: four triangles there.
  TestMesh pair = box;
  pair.add(box, {2, 2, 0});
  expectRefused(pair, 0.5f, "of 4 triangles");
}

TEST(SoftLattice, CellsThatCannotBeAreRefused) {
  const TestMesh box = boxMesh({1, 1, 1});
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float cell : {0.0f, -1.0f, nan, infinity}) expectRefused(box, cell, "cellSize");
  expectRefused(box, 0.02f, "makes 1e+06 cubes of the surface's bounds, must be at most 500000");
  TestMesh far = box;
  for (Vec3& v : far.vertices) v.x += 100000;
  expectRefused(far, 1, "must be at least 10.0001");
  // A plate that no lattice point lies in.
  expectRefused(boxMesh({1, 0.01f, 1}), 1.9f, "must be less: no tetrahedron");
  EXPECT_THROW(latticeOf(box, 1, static_cast<LatticeFit>(7)), Error);
}

TEST(SoftLattice, ABoxOfWholeCellsIsMetExactly) {
  const TestMesh box = boxMesh({0.5f, 1, 0.75f});
  for (const LatticeFit fit : {LatticeFit::Surface, LatticeFit::Cover}) {
    const auto mesh = latticeOf(box, 0.25f, fit);
    EXPECT_NEAR(mesh->volume(), 3, fit == LatticeFit::Surface ? 1e-6 : 0.8);
    EXPECT_EQ(mesh->report().inverted + mesh->report().degenerate + mesh->report().duplicate, 0u);
    EXPECT_EQ(qualityOf(*mesh).pieces, 1u);
    EXPECT_GE(qualityOf(*mesh).leastAngle, 44.9 * kDegree);
  }
}

TEST(SoftLattice, SameBitsFromEveryCompiler) {
  const TestMesh solid = tetrahedronMesh();
  EXPECT_EQ(latticeOf(solid, 0.13f)->contentHash(), 0x61d6bb964fde29f4u);
  EXPECT_EQ(latticeOf(solid, 0.13f, LatticeFit::Cover)->contentHash(), 0x0cc7c3228ede1599u);
}

struct Case {
  const char* name;
  TestMesh surface;
  float cell;
  double volumeError;  ///< of a 1
};

std::vector<Case> cases() {
  return {{"torus", torusMesh(0.5f, 0.2f, 48, 24), 0.1f, 0.03},
          {"torus, fine", torusMesh(0.5f, 0.2f, 48, 24), 0.05f, 0.01},
          {"l", lMesh(), 0.11f, 0.06},
          {"bowl", bowlMesh(), 0.07f, 0.1},
          {"box", boxMesh({0.5f, 0.37f, 0.29f}), 0.09f, 0.05}};
}

TEST(SoftLattice, PointsOfTheOutsideLieOnTheSurface) {
  for (const Case& c : cases()) {
    const auto mesh = latticeOf(c.surface, c.cell);
    const ClosedSurface surface(c.surface.vertices, c.surface.triangles);
    double worst = 0;
    for (const auto& face : mesh->surface())
      for (const uint32_t p : face) worst = std::fmax(worst, surface.nearest(toDouble(mesh->points()[p])).distance);
    EXPECT_LE(worst, 1e-4 * double{c.cell}) << c.name;
    EXPECT_NEAR(mesh->volume() / volumeOf(c.surface), 1, c.volumeError) << c.name;
  }
}

TEST(SoftLattice, NoTetrahedronIsThin) {
  for (const Case& c : cases()) {
    const auto mesh = latticeOf(c.surface, c.cell);
    const SoftMeshQuality quality = qualityOf(*mesh);
    EXPECT_EQ(mesh->report().inverted + mesh->report().degenerate + mesh->report().duplicate, 0u) << c.name;
    EXPECT_EQ(mesh->report().unused, 0u) << c.name;
    EXPECT_GE(quality.leastAngle, 9 * kDegree) << c.name;
    EXPECT_LE(quality.greatestAngle, 165 * kDegree) << c.name;
    EXPECT_GE(quality.leastRadiusRatio, 0.15) << c.name;
    EXPECT_GE(quality.leastHeight, 0.1 * double{c.cell}) << c.name;
  }
}

TEST(SoftLattice, ACoverHoldsTheSolid) {
  for (const Case& c : cases()) {
    const auto mesh = latticeOf(c.surface, c.cell, LatticeFit::Cover);
    std::vector<std::array<uint32_t, 3>> faces(mesh->surface().begin(), mesh->surface().end());
    const ClosedSurface outside(mesh->points(), faces);
    double farthest = 0;
    for (const Vec3& v : c.surface.vertices) {
      const auto nearest = outside.nearest(toDouble(v));
      if (!nearest.behind) farthest = std::fmax(farthest, nearest.distance);
    }
    EXPECT_LE(farthest, double{c.cell} / 15) << c.name;
    EXPECT_GT(mesh->volume(), volumeOf(c.surface)) << c.name;
    const SoftMeshQuality quality = qualityOf(*mesh);
    EXPECT_NEAR(quality.leastAngle, 60 * kDegree, 1e-3) << c.name;
    EXPECT_NEAR(quality.greatestAngle, 90 * kDegree, 1e-3) << c.name;
  }
}

/// A depth that knows nothing of its neighbours: any sides of lattice points, and edges cut anywhere or, `edgy`, just
/// where points are no longer moved. Outside near the border of 9 cubes.
struct Noise {
  uint64_t seed;
  bool edgy;
  double operator()(Vec3d p) const {
    for (const double v : {p.x, p.y, p.z})
      if (v < 1.25 || v > 7.75) return -1;
    uint64_t hash = seed;
    for (const double v : {p.x, p.y, p.z}) {
      hash = (hash ^ static_cast<uint64_t>(static_cast<int64_t>(v * 1048576))) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    const double draw = static_cast<double>(hash >> 11) / 9007199254740992.0;
    // Zero where it is asked first between lattice points: the ratio of their depths tells where that is.
    const auto isOfLattice = [](double v) { return std::fabs(2 * v - std::round(2 * v)) < 1e-9; };
    if (!isOfLattice(p.x) || !isOfLattice(p.y) || !isOfLattice(p.z)) return 0;
    if (!edgy) return draw < 0.5 ? draw - 0.51 : draw - 0.49;
    constexpr double kSizes[] = {1, 0.26001 / 0.73999, 0.73999 / 0.26001, 0.42001 / 0.57999, 0.57999 / 0.42001, 1e-3};
    return kSizes[(hash >> 20) % 6] * (draw < 0.5 ? -0.1 : 0.1);
  }
};

std::shared_ptr<const SoftMeshData> softOf(const LatticeMesh& mesh) {
  std::vector<Vec3> points;
  for (const Vec3d& p : mesh.points) points.push_back(toFloat(p));
  return makeTetMesh({points, mesh.tets});
}

TEST(Lattice, StencilsOfAnySidesFitEachOtherAndNoneIsThin) {
  SoftMeshQuality worst{.leastAngle = 4, .leastRadiusRatio = 1, .leastHeight = 1};
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const Lattice lattice({}, 1, {9, 9, 9});
    const LatticeMesh cut = cutLattice(lattice, Noise{seed, seed % 2 == 0});
    const auto mesh = softOf(cut);
    EXPECT_EQ(mesh->report().inverted + mesh->report().degenerate + mesh->report().duplicate, 0u);
    // Where two stencils did not fit, a point within the solid, which has not moved, would be one of the outside.
    for (const auto& face : mesh->surface())
      for (const uint32_t p : face) {
        const uint32_t point = mesh->sourcePoint(p);
        EXPECT_TRUE(point >= lattice.pointCount() || cut.points[point] != lattice.at(point));
      }
    const SoftMeshQuality quality = qualityOf(*mesh);
    worst.leastAngle = std::fmin(worst.leastAngle, quality.leastAngle);
    worst.greatestAngle = std::fmax(worst.greatestAngle, quality.greatestAngle);
    worst.leastRadiusRatio = std::fmin(worst.leastRadiusRatio, quality.leastRadiusRatio);
    worst.leastHeight = std::fmin(worst.leastHeight, quality.leastHeight);
  }
  EXPECT_GE(worst.leastAngle, 9 * kDegree);
  EXPECT_LE(worst.greatestAngle, 165 * kDegree);
}

TEST(Lattice, ItsTetrahedraFillSpaceOnce) {
  const Lattice lattice({-1, -2, -3}, 0.5, {4, 5, 6});
  const LatticeMesh cut = cutLattice(lattice, [](Vec3d) { return 5; });
  EXPECT_EQ(cut.tets.size(), size_t{4} * (3 * 5 * 6 + 4 * 4 * 6 + 4 * 5 * 5));
  const auto mesh = softOf(cut);
  EXPECT_EQ(mesh->report().inverted, 0u);
  // Each is a twelfth of a cube.
  EXPECT_NEAR(mesh->volume(), static_cast<double>(cut.tets.size()) * 0.125 / 12, 1e-6);
  EXPECT_NEAR(qualityOf(*mesh).leastAngle, 60 * kDegree, 1e-5);
  EXPECT_NEAR(qualityOf(*mesh).greatestAngle, 90 * kDegree, 1e-5);
}

TEST(Lattice, TheOutsideOfABallIsClosed) {
  const Lattice lattice({-2, -2, -2}, 0.25, {16, 16, 16});
  const auto depth = [](Vec3d p) { return 1.5 - length(p); };
  const auto mesh = softOf(cutLattice(lattice, depth));
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& face : mesh->surface())
    for (size_t i = 0; i < 3; ++i) {
      ++edges[{face[i], face[(i + 1) % 3]}];
      EXPECT_NEAR(length(toDouble(mesh->points()[face[i]])), 1.5, 1e-5);
    }
  for (const auto& [edge, count] : edges) EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  EXPECT_NEAR(mesh->volume() / (4.0 / 3 * 3.14159265 * 1.5 * 1.5 * 1.5), 1, 0.02);
}

TEST(SoftLattice, QualityOfWhatIsKnown) {
  const std::vector<Vec3> regular = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const SoftMeshQuality one = qualityOf(*makeTetMesh({regular, std::vector<std::array<uint32_t, 4>>{{0, 1, 2, 3}}}));
  EXPECT_NEAR(one.leastAngle, 70.528779365509 * kDegree, 1e-12);
  EXPECT_NEAR(one.greatestAngle, one.leastAngle, 1e-12);
  EXPECT_NEAR(one.leastRadiusRatio, 1, 1e-12);
  EXPECT_NEAR(one.leastHeight, 4 / std::sqrt(3.0), 1e-12);
  EXPECT_EQ(one.pieces, 1u);
  const std::vector<Vec3> flat = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {9, 9, 9}, {10, 9, 9}, {9, 10, 9}};
  const SoftMeshQuality two =
      qualityOf(*makeClothMesh({flat, std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {3, 4, 5}}}));
  EXPECT_NEAR(two.greatestAngle, 90 * kDegree, 1e-12);
  EXPECT_NEAR(std::sin(two.leastAngle), 1 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(two.leastHeight, 1 / std::sqrt(2.0), 1e-6);
  EXPECT_EQ(two.pieces, 2u);
}

}  // namespace
}  // namespace avbd
