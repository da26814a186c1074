// A convex shape on rough surfaces: against every triangle in double, and laws: moved, turned, scaled, resting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "collide/collide_convex_oracle.h"
#include "collide/collide_surface_oracle.h"

namespace avbd::surface_test {
namespace {

Vec3d crossOf(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// Nearest point of a triangle in double: the foot if it lies inside, else the best of the three edges.
Vec3d closest(Vec3d p, const std::array<Vec3, 3>& t) {
  const Vec3d v[3] = {toDouble(t[0]), toDouble(t[1]), toDouble(t[2])};
  const Vec3d n = crossOf(v[1] - v[0], v[2] - v[0]);
  const Vec3d foot = p - n * (dot(n, p - v[0]) / dot(n, n));
  bool inside = true;
  Vec3d best;
  double least = 1e300;
  for (int i = 0; i < 3; ++i) {
    const Vec3d a = v[i], e = v[(i + 1) % 3] - a;
    inside = inside && dot(crossOf(n, e), p - a) >= 0;
    const Vec3d on = a + e * std::clamp(dot(p - a, e) / dot(e, e), 0.0, 1.0);
    if (dot(p - on, p - on) < least) {
      least = dot(p - on, p - on);
      best = on;
    }
  }
  return inside ? foot : best;
}

struct Rough {
  Geometry geometry;
  std::vector<std::array<Vec3, 3>> triangles;
};

/// Bumps of all widths; the surface stays a graph over x and z, so that above is in front.
Rough roughMesh(int cells, float spacing, float height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  const Geometry geometry = meshOf(grid(cells, cells, spacing, [&](float, float) { return height * unit(random); }));
  Rough r{geometry, {}};
  const MeshData& data = *std::get<Mesh>(geometry).data;
  for (uint32_t i = 0; i < data.triangleCount(); ++i) r.triangles.push_back(data.triangle(i));
  return r;
}

/// Spheres above, on and in rough ground: the deepest contact is the nearest point of all triangles, and there is none
/// where there is nothing near.
TEST(CollideSurfaceLaw, spheresMatchTheNearestOfAllTriangles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  int touched = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Rough rough = roughMesh(12, 0.5f, seed % 2 == 0 ? 0.1f : 0.6f, seed);
    for (int i = 0; i < 400; ++i) {
      const Vec3 c{2 * unit(random), 0.5f + 0.6f * unit(random), 2 * unit(random)};
      const float radius = 0.3f;
      double least = 1e300;
      Vec3d nearest;
      bool above = true;
      for (const auto& t : rough.triangles) {
        const Vec3d on = closest(toDouble(c), t), d = on - toDouble(c);
        if (dot(d, d) >= least) continue;
        least = dot(d, d);
        nearest = on;
        const Vec3d n = crossOf(toDouble(t[1]) - toDouble(t[0]), toDouble(t[2]) - toDouble(t[0]));
        above = dot(n, toDouble(c) - on) > 0;
      }
      if (!above) continue;
      const double distance = std::sqrt(least), gap = distance - radius;
      if (distance < 0.02 || std::fabs(gap - 0.05) < 1e-4) continue;
      const auto patches =
          touch(toShapeGeom(Sphere{radius}), {c, turned(unit(random), {1, 2, 3})}, rough.geometry, {}, 0.05f);
      ASSERT_EQ(patches.empty(), gap > 0.05) << seed << ' ' << i;
      if (patches.empty()) continue;
      ++touched;
      EXPECT_NEAR(deepest(patches[0].manifold), gap, 2e-5) << seed << ' ' << i;
      const Vec3 direction = toFloat((nearest - toDouble(c)) * (1 / distance));
      EXPECT_GT(dot(patches[0].manifold.normal, direction), 0.9998f) << seed << ' ' << i;
    }
  }
  EXPECT_GT(touched, 300);
}

using Edges = std::vector<std::pair<Vec3d, Vec3d>>;

/// Corners and edges of a shape's core; a curved one has none.
void coreOf(const ShapeGeom& g, const NearPose& pose, std::vector<Vec3d>& corners, Edges& edges) {
  if (g.type == ShapeType::Hull) {
    const auto at = [&](size_t i) { return oracle::unitRotate(pose.q, toDouble(g.hull().vertices()[i])) + pose.p; };
    for (size_t i = 0; i < g.hull().vertices().size(); ++i) corners.push_back(at(i));
    for (const auto& e : g.hull().edges()) edges.push_back({at(e.vertex[0]), at(e.vertex[1])});
  } else if (g.type == ShapeType::Box || g.type == ShapeType::Capsule) {
    const oracle::Solid s = oracle::solidOf(g, pose);
    corners = s.corners;
    for (const auto& e : s.edges)
      edges.push_back({corners[static_cast<size_t>(e.first)], corners[static_cast<size_t>(e.second)]});
  }
}

/// The gap of a shape and a triangle: the largest over the directions between their corners and edges and of their
/// faces, among which the best one is where both are made of these; for a curved shape by climbing.
double gapToTriangle(const ShapeGeom& geom, const NearPose& pose, const std::array<Vec3, 3>& t,
                     std::mt19937& climbing) {
  ShapeGeom triangle{ShapeType::Triangle, 0, {}};
  triangle.data = t.data();
  const oracle::Asked asked{geom, triangle, pose, {}};
  std::vector<Vec3d> corners, tries, along, v{toDouble(t[0]), toDouble(t[1]), toDouble(t[2])};
  Edges edges, sides{{v[0], v[1]}, {v[1], v[2]}, {v[2], v[0]}};
  coreOf(geom, pose, corners, edges);
  double best = -1e300;
  if (corners.empty()) {
    for (int k = 0; k < 6; ++k)
      best = std::fmax(best, oracle::largestGap(asked, v[0] - pose.p, 200 + 31 * k, climbing));
    return best;
  }
  oracle::flatParts(geom, pose.q, tries, along);
  oracle::flatParts(triangle, {}, tries, along);
  const auto across = [](Vec3d d, const std::pair<Vec3d, Vec3d>& e) {
    const Vec3d u = e.second - e.first;
    return d - u * (dot(d, u) / dot(u, u));
  };
  for (const Vec3d& a : corners) {
    for (const Vec3d& b : v) tries.push_back(b - a);
    for (const auto& e : sides) tries.push_back(across(e.first - a, e));
  }
  for (const auto& e : edges) {
    for (const Vec3d& b : v) tries.push_back(across(b - e.first, e));
    for (const auto& f : sides) {
      tries.push_back(crossOf(e.second - e.first, f.second - f.first));
      tries.push_back(tries.back() * -1.0);
    }
  }
  for (const Vec3d& n : tries) {
    if (length(n) > 1e-9) best = std::fmax(best, asked.gap(oracle::unitOf(n)));
  }
  return best;
}

/// The gap of a shape and the nearest of many triangles, if it is below `most`.
double gapToNearest(const ShapeGeom& geom, const NearPose& pose, const Rough& rough, double most,
                    std::mt19937& climbing) {
  constexpr double kReach = 0.55;  // of all shapes below
  double least = most;
  for (const auto& t : rough.triangles) {
    if (length(closest(toDouble(pose.p), t) - pose.p) - kReach > least) continue;
    least = std::fmin(least, gapToTriangle(geom, pose, t, climbing));
  }
  return least;
}

/// Shapes that hover over rough ground: the least separation is the distance to the nearest of all triangles.
TEST(CollideSurfaceLaw, hoveringShapesMatchTheNearestOfAllTriangles) {
  std::mt19937 random(5), climbing(1);
  std::uniform_real_distribution<float> unit(-1, 1);
  const Geometry shapes[] = {Box{0.4f, 0.2f, 0.3f}, Capsule{0.15f, 0.3f}, Cylinder{0.3f, 0.2f},
                             Hull{prism(0.4f, 0.2f)}};
  int touched = 0;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Rough rough = roughMesh(8, 0.5f, 0.4f, seed);
    for (int i = 0; i < 240; ++i) {
      const ShapeGeom geom = toShapeGeom(shapes[i % 4]);
      const NearPose pose{{unit(random), 0.7f + 0.4f * unit(random), unit(random)},
                          turned(3 * unit(random), {unit(random), unit(random), 1})};
      constexpr float kMargin = 0.1f;
      const double least = gapToNearest(geom, pose, rough, 2 * kMargin, climbing);
      if (least < 1e-3 || std::fabs(least - kMargin) < 1e-3) continue;
      const auto patches = touch(geom, pose, rough.geometry, {}, kMargin);
      ASSERT_EQ(patches.empty(), least > kMargin) << seed << ' ' << i << " at " << least;
      if (patches.empty()) continue;
      ++touched;
      // Directions within a hundredth of a face's count as the face's.
      EXPECT_NEAR(deepest(patches[0].manifold), least, 1e-3) << seed << ' ' << i;
    }
  }
  EXPECT_GT(touched, 60);
}

struct Case {
  Geometry convex;
  NearPose pose;
};

/// Positions on a lattice, so that moving by whole numbers rounds nothing.
std::vector<Case> cases(int count) {
  std::mt19937 random(11);
  const auto lattice = [&](float size) {
    return static_cast<float>(std::uniform_int_distribution<int>(-1024, 1024)(random)) * (size / 1024);
  };
  const Geometry shapes[] = {Sphere{0.25f},          Box{0.5f, 0.25f, 0.25f},  Capsule{0.25f, 0.5f},
                             Cylinder{0.25f, 0.25f}, Hull{prism(0.5f, 0.25f)}, Box{0.25f, 0.25f, 0.25f, 0.125f}};
  std::vector<Case> all;
  for (int i = 0; i < count; ++i) {
    all.push_back(
        {shapes[i % 6],
         {{lattice(2), 0.25f + lattice(0.5f), lattice(2)}, turned(lattice(3), {lattice(1), lattice(1), 1.5f})}});
  }
  return all;
}

void expectSame(const std::vector<SurfacePatch>& a, const std::vector<SurfacePatch>& b, Vec3 moved, float scale) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    const Manifold &m = a[i].manifold, &n = b[i].manifold;
    EXPECT_EQ(m.normal, n.normal);
    ASSERT_EQ(m.count, n.count);
    EXPECT_EQ(a[i].element, b[i].element);
    for (int k = 0; k < m.count; ++k) {
      EXPECT_EQ(m.points[k].separation * scale, n.points[k].separation);
      EXPECT_EQ(m.points[k].feature, n.points[k].feature);
      EXPECT_LT(length(m.points[k].position * scale + moved - n.points[k].position), 2e-6f * scale);
    }
  }
}

TEST(CollideSurfaceLaw, movedTogetherNothingChanges) {
  const Rough rough = roughMesh(10, 0.5f, 0.25f, 1);
  const Vec3 by{4, -8, 16};
  int patches = 0;
  for (const Case& c : cases(300)) {
    const ShapeGeom geom = toShapeGeom(c.convex);
    const auto here = touch(geom, c.pose, rough.geometry, {}, 0.05f);
    expectSame(here, touch(geom, {c.pose.p + by, c.pose.q}, rough.geometry, {by, {}}, 0.05f), by, 1);
    patches += static_cast<int>(here.size());
  }
  EXPECT_GT(patches, 150);
}

TEST(CollideSurfaceLaw, turnedTogetherOnlyTheFrameChanges) {
  const Rough rough = roughMesh(10, 0.5f, 0.25f, 1);
  for (const Case& c : cases(120)) {
    const Quat q = turned(0.7f, {1, -2, 0.5f});
    const ShapeGeom geom = toShapeGeom(c.convex);
    const auto here = touch(geom, c.pose, rough.geometry, {}, 0.05f);
    const auto there = touch(geom, {rotate(q, c.pose.p), q * c.pose.q}, rough.geometry, {{}, q}, 0.05f);
    ASSERT_EQ(here.empty(), there.empty());
    if (here.empty()) continue;
    EXPECT_NEAR(deepest(here[0].manifold), deepest(there[0].manifold), 1e-4f);
  }
}

TEST(CollideSurfaceLaw, twiceTheSizeGivesTwiceTheDistances) {
  const SurfaceDef ground =
      grid(10, 10, 0.5f, [](float x, float z) { return 0.25f * std::floor(2 * x) * std::floor(2 * z) - 0.125f * z; });
  Mesh small = std::get<Mesh>(meshOf(ground)), large = small;
  large.scale = {2, 2, 2};
  for (const Case& c : cases(240)) {
    ShapeGeom geom = toShapeGeom(c.convex);
    if (geom.type == ShapeType::Hull) continue;
    const auto here = touch(geom, c.pose, small, {}, 0.05f);
    geom.radius *= 2;
    geom.extent = geom.extent * 2;
    const auto there = touch(geom, {c.pose.p * 2, c.pose.q}, large, {}, 0.1f);
    expectSame(here, there, {}, 2);
  }
}

TEST(CollideSurfaceLaw, aScaledMeshIsAsOneMadeSo) {
  const SurfaceDef ground =
      grid(10, 10, 0.5f, [](float x, float z) { return 0.25f * std::floor(2 * x) * std::floor(2 * z) - 0.125f * z; });
  SurfaceDef made = ground;
  const Vec3 scale{2, 0.5f, 4};
  for (Vec3& v : made.vertices) v = {v.x * scale.x, v.y * scale.y, v.z * scale.z};
  Mesh scaled = std::get<Mesh>(meshOf(ground));
  scaled.scale = scale;
  const Geometry other = meshOf(made);
  for (const Case& c : cases(200)) {
    const ShapeGeom geom = toShapeGeom(c.convex);
    const auto a = touch(geom, c.pose, scaled, {}, 0.05f), b = touch(geom, c.pose, other, {}, 0.05f);
    ASSERT_EQ(a.empty(), b.empty());
    if (!a.empty()) {
      EXPECT_EQ(deepest(a[0].manifold), deepest(b[0].manifold));
    }
  }
}

/// A height field is the mesh of its triangles, as long as the shape's centre is above it and no border is near.
TEST(CollideSurfaceLaw, aHeightFieldIsTheMeshOfItsTriangles) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(-1, 1);
  const Geometry field = fieldOf(15, 15, 0.5f, [&](float, float) { return 0.25f * unit(random); });
  const HeightFieldData& data = *std::get<HeightField>(field).data;
  SurfaceDef def;
  for (uint32_t i = 0; i < data.triangleCount(); ++i)
    triangle(def, data.triangle(i)[0], data.triangle(i)[1], data.triangle(i)[2]);
  const Geometry mesh = meshOf(def);
  int patches = 0;
  for (Case c : cases(300)) {
    c.pose.p.y += 0.5f;
    const ShapeGeom geom = toShapeGeom(c.convex);
    const auto a = touch(geom, c.pose, field, {}, 0.05f), b = touch(geom, c.pose, mesh, {}, 0.05f);
    ASSERT_EQ(a.size(), b.size());
    patches += static_cast<int>(a.size());
    for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(deepest(a[i].manifold), deepest(b[i].manifold), 1e-5f);
  }
  EXPECT_GT(patches, 50);
}

/// What every answer must have: unit normals, unique names, points within the margin, deepest first, no push of the
/// shape's middle through the surface.
TEST(CollideSurfaceLaw, answersAreWellFormedHoweverDeep) {
  const Rough rough = roughMesh(30, 0.3f, 0.4f, 2);
  for (const float margin : {0.1f, 0.6f}) {
    for (const Case& c : cases(1000)) {
      const auto patches = touch(toShapeGeom(c.convex), c.pose, rough.geometry, {}, margin);
      std::vector<uint32_t> names;
      for (size_t i = 0; i < patches.size(); ++i) {
        const Manifold& m = patches[i].manifold;
        EXPECT_NEAR(length(m.normal), 1, 1e-5f);
        EXPECT_LT(m.normal.y, 0.05f);
        ASSERT_GE(m.count, 1);
        EXPECT_LE(deepest(patches[i == 0 ? 0 : i - 1].manifold), deepest(m) + 1e-6f);
        for (int k = 0; k < m.count; ++k) {
          EXPECT_LE(m.points[k].separation, margin + 1e-5f);
          names.push_back(m.points[k].feature);
        }
        EXPECT_LT(patches[i].element, rough.triangles.size());
      }
      std::sort(names.begin(), names.end());
      EXPECT_TRUE(std::adjacent_find(names.begin(), names.end()) == names.end());
    }
  }
}

/// Where the points' depths differ, the deepest need not be the first.
TEST(CollideSurfaceLaw, theElementIsTheTriangleOfTheFirstPoint) {
  const Rough rough = roughMesh(30, 0.3f, 0.2f, 2);
  int several = 0;
  for (const Case& c : cases(600)) {
    for (const SurfacePatch& p : touch(toShapeGeom(c.convex), c.pose, rough.geometry, {}, 0.1f)) {
      const ManifoldPoint& first = p.manifold.points[0];
      const Vec3d at = toDouble(first.position), on = closest(at, rough.triangles[p.element]);
      EXPECT_LT(length(at - on), 0.51 * std::fabs(first.separation) + 1e-3);
      several += p.manifold.count > 1 && first.separation > deepest(p.manifold);
    }
  }
  EXPECT_GT(several, 0);
}

/// A slab on thousands of triangles touches with its corners, as on two.
TEST(CollideSurfaceLaw, aSlabOnAFineMeshTouchesAsOnACoarseOne) {
  const ShapeGeom slab = toShapeGeom(Box{5, 0.25f, 5});
  const Geometry coarse = meshOf(grid(1, 1, 16, flat)), fine = meshOf(grid(160, 160, 0.1f, flat));
  for (const float height : {0.26f, 0.25f, 0.2f}) {
    const NearPose pose{{0.03f, height, -0.04f}, turned(0.3f, {0, 1, 0})};
    const auto few = touch(slab, pose, coarse, {}, 0.02f), many = touch(slab, pose, fine, {}, 0.02f);
    ASSERT_EQ(few.size(), 1u);
    ASSERT_EQ(many.size(), 1u);
    ASSERT_EQ(few[0].manifold.count, 4);
    ASSERT_EQ(many[0].manifold.count, 4);
    for (const ManifoldPoint& p : few[0].manifold.points) {
      const auto& points = many[0].manifold.points;
      const auto same = std::find_if(std::begin(points), std::end(points),
                                     [&](const ManifoldPoint& q) { return q.feature == p.feature; });
      ASSERT_NE(same, std::end(points));
      EXPECT_LT(length(same->position - p.position), 1e-5f);
      EXPECT_NEAR(same->separation, p.separation, 1e-6f);
    }
  }
}

/// At rest, with the small movements that rest has, points keep their names.
TEST(CollideSurfaceLaw, namesStayWhileABoxRests) {
  const Geometry ground = meshOf(grid(20, 20, 0.3f, flat));
  const ShapeGeom box = toShapeGeom(Box{0.5f, 0.5f, 0.5f});
  const Quat yaw = turned(0.3f, {0, 1, 0});
  std::vector<uint32_t> first;
  for (int i = 0; i < 50; ++i) {
    const float s = 1e-4f * static_cast<float>(i % 7 - 3);
    const auto patches =
        touch(box, {{0.13f + s, 0.499f + s, 0.21f - s}, yaw * turned(0.3f * s, {1, 0, 1})}, ground, {}, 0.02f);
    ASSERT_EQ(patches.size(), 1u);
    std::vector<uint32_t> names;
    for (int k = 0; k < patches[0].manifold.count; ++k) names.push_back(patches[0].manifold.points[k].feature);
    std::sort(names.begin(), names.end());
    if (i == 0) first = names;
    EXPECT_EQ(names, first);
  }
}

/// Corners of the shape that lie in faces keep their names from triangle to triangle.
TEST(CollideSurfaceLaw, cornersKeepTheirNamesWhileTheySlide) {
  const Geometry ground = meshOf(grid(20, 20, 0.3f, flat));
  const ShapeGeom box = toShapeGeom(Box{0.5f, 0.5f, 0.5f});
  std::vector<uint32_t> first;
  for (int i = 0; i < 100; ++i) {
    const auto patches = touch(box, {{-1 + 0.0173f * static_cast<float>(i), 0.499f, 0.017f}, turned(0.3f, {0, 1, 0})},
                               ground, {}, 0.02f);
    ASSERT_EQ(patches.size(), 1u);
    std::vector<uint32_t> names;
    for (int k = 0; k < patches[0].manifold.count; ++k) names.push_back(patches[0].manifold.points[k].feature);
    std::sort(names.begin(), names.end());
    if (i == 0) first = names;
    EXPECT_EQ(names, first) << i;
  }
}

}  // namespace
}  // namespace avbd::surface_test
