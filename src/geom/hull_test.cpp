// Hulls: what must hold of every one, on clouds that break builders; scaled copies; what is refused.
#include "geom/hull.h"

#include <avbd/error.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "geom/hull_cases.h"
#include "geom/hull_math.h"

namespace avbd {
namespace {

using Halves = std::set<std::pair<int, int>>;

/// What planes in floats may be off.
double slackOf(const HullData& hull) {
  double largest = 0;
  for (const Vec3& v : hull.vertices()) {
    largest = std::max({largest, std::fabs(1.0 * v.x), std::fabs(1.0 * v.y), std::fabs(1.0 * v.z)});
  }
  return largest * 0x1p-22;
}

/// Closed, convex, of three or more faces at each vertex.
Halves expectClosedAndConvex(const HullData& hull) {
  const auto vertices = hull.vertices();
  const auto faces = hull.faces();
  const double slack = slackOf(hull);
  // Closed: every directed edge once, its opposite once.
  Halves halves;
  std::vector<int> degree(vertices.size());
  for (const HullData::Face& face : faces) {
    EXPECT_GE(face.count, 3);
    EXPECT_NEAR(length(toDouble(face.normal)), 1, 1e-6);
    std::set<int> own;
    for (int i = 0; i < face.count; ++i) {
      const int a = hull.loops()[face.first + i], b = hull.loops()[face.first + (i + 1) % face.count];
      EXPECT_LT(a, static_cast<int>(vertices.size()));
      EXPECT_TRUE(own.insert(a).second) << "a vertex twice in one face";
      EXPECT_TRUE(halves.insert({a, b}).second) << "an edge twice in one direction";
      ++degree[a];
      // Strictly convex loops, seen from outside.
      const int c = hull.loops()[face.first + (i + 2) % face.count];
      const Vec3d u = toDouble(vertices[b]) - toDouble(vertices[a]), v = toDouble(vertices[c]) - toDouble(vertices[b]);
      EXPECT_GT(dot(cross(u, v), toDouble(face.normal)), 0) << "face of " << face.count;
    }
    // Planes support the hull; the face's own vertices lie close below.
    for (const Vec3& v : vertices) EXPECT_LE(dot(toDouble(face.normal), toDouble(v)) - face.offset, slack);
  }
  for (const auto& [a, b] : halves) EXPECT_TRUE(halves.contains({b, a})) << "an open edge";
  for (int d : degree) EXPECT_GE(d, 3);
  return halves;
}

void expectEdges(const HullData& hull, const Halves& halves) {
  const auto vertices = hull.vertices();
  const auto faces = hull.faces();
  EXPECT_EQ(halves.size(), 2 * hull.edges().size());
  EXPECT_EQ(static_cast<int>(vertices.size()) - static_cast<int>(hull.edges().size()) + static_cast<int>(faces.size()),
            2);
  for (const HullData::Edge& e : hull.edges()) {
    const auto has = [&](int f, int a, int b) {
      const HullData::Face& face = faces[f];
      for (int i = 0; i < face.count; ++i) {
        if (hull.loops()[face.first + i] == a && hull.loops()[face.first + (i + 1) % face.count] == b) return true;
      }
      return false;
    };
    EXPECT_TRUE(has(e.face[0], e.vertex[0], e.vertex[1]));
    EXPECT_TRUE(has(e.face[1], e.vertex[1], e.vertex[0]));
    const auto n = hull.neighbors(e.vertex[0]);
    EXPECT_TRUE(std::find(n.begin(), n.end(), e.vertex[1]) != n.end());
  }
  size_t neighbors = 0;
  for (size_t v = 0; v < vertices.size(); ++v) neighbors += hull.neighbors(static_cast<int>(v)).size();
  EXPECT_EQ(neighbors, halves.size());
}

/// Everything that a hull promises.
void expectValid(const HullData& hull, std::span<const Vec3> points) {
  const auto vertices = hull.vertices();
  const auto faces = hull.faces();
  const double slack = slackOf(hull);
  ASSERT_GE(vertices.size(), 4u);
  ASSERT_LE(vertices.size(), 255u);
  const Halves halves = expectClosedAndConvex(hull);
  expectEdges(hull, halves);
  // Bounds and the inner ball.
  for (const Vec3& v : vertices) {
    EXPECT_TRUE(v.x >= hull.lower().x && v.y >= hull.lower().y && v.z >= hull.lower().z);
    EXPECT_TRUE(v.x <= hull.upper().x && v.y <= hull.upper().y && v.z <= hull.upper().z);
  }
  EXPECT_GE(hull.innerRadius(), 0);
  for (const HullData::Face& face : faces) {
    EXPECT_LE(dot(toDouble(face.normal), toDouble(hull.center())) + hull.innerRadius(), face.offset + slack);
  }
  // Vertices are points given; every point lies within error() of the hull.
  std::vector<Vec3d> corners;
  for (const Vec3& v : vertices) corners.push_back(toDouble(v));
  std::set<std::array<float, 3>> given;
  for (const Vec3& p : points) given.insert({p.x, p.y, p.z});
  for (const Vec3& v : vertices) EXPECT_TRUE(given.contains({v.x, v.y, v.z}));
  double worst = 0;
  const double extent = length(hull.upper() - hull.lower());
  for (const Vec3& p : points) worst = std::max(worst, length(toDouble(p) - nearestInHull(toDouble(p), corners)));
  EXPECT_LE(worst, hull.error() + 1e-9 * extent);
  EXPECT_GE(worst, hull.error() * (1 - 1e-6) - 1e-9 * extent) << "error() is no bound but the distance itself";
}

/// Largest distance of a face's own vertices below its plane.
double unevenness(const HullData& hull) {
  double worst = 0;
  for (const HullData::Face& face : hull.faces()) {
    for (int i = 0; i < face.count; ++i) {
      const Vec3 v = hull.vertices()[hull.loops()[face.first + i]];
      worst = std::max(worst, face.offset - dot(toDouble(face.normal), toDouble(v)));
    }
  }
  return worst;
}

TEST(Hull, tetrahedron) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto hull = makeHull({.points = points});
  expectValid(*hull, points);
  EXPECT_EQ(hull->faces().size(), 4u);
  EXPECT_EQ(hull->error(), 0);
  EXPECT_FLOAT_EQ(hull->massProperties(6).mass, 1);
  EXPECT_FLOAT_EQ(hull->massProperties(6).center.x, 0.25f);
  // r (3 + sqrt 3) = 1 for the ball that touches all four.
  EXPECT_NEAR(hull->innerRadius(), 1 / (3 + std::sqrt(3.0)), 1e-5);
}

TEST(Hull, gridIsABoxOfSixFaces) {
  std::vector<Vec3> points = cloud(Cloud::Grid, 1000, 1);
  const auto hull = makeHull({.points = points});
  expectValid(*hull, points);
  EXPECT_EQ(hull->vertices().size(), 8u);
  EXPECT_EQ(hull->faces().size(), 6u);
  EXPECT_EQ(hull->edges().size(), 12u);
  EXPECT_LT(unevenness(*hull), 1e-6);
}

TEST(Hull, holdsForEveryCloud) {
  for (int kind = 0; kind < kCloudCount; ++kind) {
    for (uint32_t seed = 1; seed <= 3; ++seed) {
      for (float size : {1.0f, 1e-5f, 1e5f}) {
        std::vector<Vec3> points = cloud(static_cast<Cloud>(kind), 40 + 60 * seed, seed);
        for (Vec3& p : points) p = p * size;
        SCOPED_TRACE("cloud " + std::to_string(kind) + " seed " + std::to_string(seed) + " size " +
                     std::to_string(size));
        for (int limit : {255, 20, 4}) {
          const auto hull = makeHull({.points = points, .maxVertices = limit});
          expectValid(*hull, points);
          EXPECT_LE(hull->vertices().size(), static_cast<size_t>(limit));
          const float tolerance = 1e-4f * 2.1f * size;
          EXPECT_LE(unevenness(*hull), tolerance);
          if (limit == 255) {
            EXPECT_LE(hull->error(), tolerance);
          }
        }
      }
    }
  }
}

TEST(Hull, farFromTheOrigin) {
  for (int kind = 0; kind < kCloudCount; ++kind) {
    std::vector<Vec3> points = cloud(static_cast<Cloud>(kind), 200, 5);
    for (Vec3& p : points) p = p * 100 + Vec3{9e5f, -9e5f, 8e5f};
    SCOPED_TRACE(kind);
    if (static_cast<Cloud>(kind) == Cloud::Pancake || static_cast<Cloud>(kind) == Cloud::Needle)
      continue;  // flat in floats there
    expectValid(*makeHull({.points = points}), points);
  }
}

// What lies so near that the builder's grid does not tell it apart: one of them, always the same.
TEST(Hull, orderOfPointsThatAreAlmostEqualDoesNotMatter) {
  std::vector<Vec3> points = {{2.4e-38f, 0, 0}, {0, 0, 0}, {4.4e-39f, -1.75f, 0}, {-1.75f, -7, 2.375f},
                              {-2, 0, 0},       {0, 0, 6}, {-7.75f, -0.125f, 0}};
  const uint64_t hash = makeHull({.points = points})->contentHash();
  std::swap(points[0], points[1]);
  EXPECT_EQ(makeHull({.points = points})->contentHash(), hash);
}

TEST(Hull, orderOfPointsDoesNotMatter) {
  for (int kind = 0; kind < kCloudCount; ++kind) {
    std::vector<Vec3> points = cloud(static_cast<Cloud>(kind), 300, 7);
    const auto first = makeHull({.points = points, .maxVertices = 30});
    std::mt19937 random(3);
    for (int round = 0; round < 4; ++round) {
      std::shuffle(points.begin(), points.end(), random);
      points.push_back(points[round]);
      EXPECT_EQ(makeHull({.points = points, .maxVertices = 30})->contentHash(), first->contentHash()) << kind;
    }
  }
}

TEST(Hull, scalesExactlyByPowersOfTwo) {
  const std::vector<Vec3> points = cloud(Cloud::Sphere, 300, 9);
  std::vector<Vec3> big = points;
  for (Vec3& p : big) p = p * 8;
  const auto a = makeHull({.points = points}), b = makeHull({.points = big});
  ASSERT_EQ(a->vertices().size(), b->vertices().size());
  for (size_t i = 0; i < a->vertices().size(); ++i) EXPECT_EQ(a->vertices()[i] * 8, b->vertices()[i]);
  EXPECT_TRUE(std::ranges::equal(a->loops(), b->loops()));
  EXPECT_EQ(a->massProperties(1).inertia.xy * 32768, b->massProperties(1).inertia.xy);
}

TEST(Hull, pointsWithinToleranceAreLeftOut) {
  // A box with a low bump on its top: in or out by the tolerance alone.
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) points.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
  points.push_back({0.1f, 1.01f, 0.2f});
  const auto coarse = makeHull({.points = points, .tolerance = 0.05f});
  EXPECT_EQ(coarse->vertices().size(), 8u);
  EXPECT_EQ(coarse->faces().size(), 6u);
  EXPECT_NEAR(coarse->error(), 0.01f, 1e-6f);
  const auto fine = makeHull({.points = points, .tolerance = 0.001f});
  EXPECT_EQ(fine->vertices().size(), 9u);
  EXPECT_EQ(fine->faces().size(), 9u);
  EXPECT_EQ(fine->error(), 0);
}

TEST(Hull, innerBallOfABoxTouchesItsSides) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) points.push_back({i & 1 ? 1.0f : 0.0f, i & 2 ? 2.0f : 0.0f, i & 4 ? 7.0f : 0.0f});
  points.push_back({0.5f, 1, 12});
  EXPECT_NEAR(makeHull({.points = points})->innerRadius(), 0.5f, 1e-4f);
}

TEST(Hull, refusesByName) {
  const auto refuse = [](const HullDef& def, const std::string& field, const std::string& part) {
    try {
      makeHull(def);
      FAIL() << "accepted: " << part;
    } catch (const Error& e) {
      EXPECT_EQ(e.definition(), "HullDef");
      EXPECT_EQ(e.field(), field);
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  const std::vector<Vec3> good = cloud(Cloud::Ball, 50, 1);
  refuse({.points = std::span(good).first(3)}, "points", "3 points");
  refuse({.points = good, .maxVertices = 3}, "maxVertices", "3");
  refuse({.points = good, .maxVertices = 256}, "maxVertices", "256");
  refuse({.points = good, .tolerance = -1}, "tolerance", "-1");
  refuse({.points = good, .tolerance = NAN}, "tolerance", "nan");
  std::vector<Vec3> bad = good;
  bad[7].y = NAN;
  refuse({.points = bad}, "points[7]", "nan");
  bad[7].y = INFINITY;
  refuse({.points = bad}, "points[7]", "inf");
  bad[7].y = 2e6f;
  refuse({.points = bad}, "points[7]", "1e+06");
  refuse({.points = std::vector<Vec3>(9, {1, 2, 3})}, "points", "one point");
  std::vector<Vec3> tiny = good;
  for (Vec3& p : tiny) p = p * 1e-20f;
  refuse({.points = tiny}, "points", "must enclose more");
  // In one plane but for rounding, far from the origin.
  const std::vector<Vec3> sliver{
      {99.9990005f, -50, 25}, {100, -50.0029984f, 24.9969997f}, {100, -50.0009995f, 24.9990005f}, {100, -50, 25}};
  refuse({.points = sliver}, "points", "more than their rounding");
  std::vector<Vec3> line, plane;
  for (int i = 0; i < 20; ++i) {
    line.push_back(Vec3{1, 2, 3} * (0.1f * i));
    plane.push_back({0.1f * (i % 5), 0.1f * (i / 5), 0.1f * (i % 5) + 0.2f * (i / 5)});
  }
  refuse({.points = line}, "points", "collinear");
  refuse({.points = plane}, "points", "coplanar");
  refuse({.points = good, .tolerance = 5}, "points", "one point");
}

TEST(ScaledHull, everyVertexTimesScale) {
  const std::vector<Vec3> points = cloud(Cloud::Ball, 80, 2);
  const auto hull = makeHull({.points = points});
  for (const Vec3 scale : {Vec3{2, 3, 0.5f}, Vec3{-1, 1, 1}, Vec3{-2, -3, 1}, Vec3{-1, -1, -0.25f}}) {
    const auto scaled = scaledHull(hull, scale);
    std::vector<Vec3> expected;
    for (const Vec3& v : hull->vertices()) expected.push_back({v.x * scale.x, v.y * scale.y, v.z * scale.z});
    EXPECT_TRUE(std::ranges::equal(scaled->vertices(), expected));
    // Everything that held for a hull holds for its image; the points are its own vertices, the error is carried over.
    EXPECT_EQ(scaled->faces().size(), hull->faces().size());
    for (const HullData::Face& face : scaled->faces()) {
      EXPECT_GT(face.offset, dot(face.normal, scaled->center()));
    }
    const float volume = std::fabs(scale.x * scale.y * scale.z);
    EXPECT_NEAR(scaled->massProperties(1).mass, volume * hull->massProperties(1).mass, 1e-5 * volume);
    EXPECT_NEAR(scaled->massProperties(1).center.x, scale.x * hull->massProperties(1).center.x, 1e-5);
  }
}

TEST(ScaledHull, equalScalesShareOneObject) {
  const std::vector<Vec3> points = cloud(Cloud::Ball, 40, 3);
  const auto hull = makeHull({.points = points}), other = makeHull({.points = cloud(Cloud::Ball, 40, 4)});
  EXPECT_EQ(scaledHull(hull, {1, 1, 1}), hull);
  const auto a = scaledHull(hull, {2, 2, 2}), b = scaledHull(hull, {2, 2, 2});
  EXPECT_EQ(a, b);
  EXPECT_NE(a, scaledHull(hull, {2, 2, 3}));
  EXPECT_NE(a, scaledHull(other, {2, 2, 2}));
  std::weak_ptr<const HullData> gone = scaledHull(hull, {5, 5, 5});
  EXPECT_TRUE(gone.expired()) << "nobody uses it";
}

}  // namespace
}  // namespace avbd
