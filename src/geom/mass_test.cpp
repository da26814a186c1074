// Mass properties against closed forms and against integration by sampling.
#include "geom/mass.h"

#include <avbd/hull.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "geom/hull_cases.h"
#include "geom/hull_math.h"

namespace avbd {
namespace {

constexpr double kPi = 3.14159265358979323846;

double clamped(double v, double low, double high) { return std::fmax(low, std::fmin(high, v)); }

/// Distance from a cone's core in its half plane (radius, height): a triangle's.
double coneDistance(const Cone& c, Vec3d p) {
  const Vec3d at{std::sqrt(p.x * p.x + p.z * p.z), p.y, 0};
  const Vec3d triangle[] = {{0, -c.halfHeight, 0}, {c.radius, -c.halfHeight, 0}, {0, c.halfHeight, 0}};
  return length(at - nearestInTriangle(at, triangle[0], triangle[1], triangle[2]));
}

/// Written from what the shapes mean: no farther from the core than the rounding.
bool inside(const Geometry& geometry, Vec3d p) {
  if (const auto* s = std::get_if<Sphere>(&geometry)) return length(p) <= s->radius;
  if (const auto* b = std::get_if<Box>(&geometry)) {
    const Vec3d q{clamped(p.x, -b->x, b->x), clamped(p.y, -b->y, b->y), clamped(p.z, -b->z, b->z)};
    return length(p - q) <= b->rounding;
  }
  if (const auto* c = std::get_if<Cylinder>(&geometry)) {
    const double radial = std::sqrt(p.x * p.x + p.z * p.z);
    return length(Vec3d{radial - clamped(radial, 0, c->radius), p.y - clamped(p.y, -c->halfHeight, c->halfHeight),
                        0}) <= c->rounding;
  }
  if (const auto* c = std::get_if<Cone>(&geometry)) return coneDistance(*c, p) <= c->rounding + 1e-12;
  if (const auto* e = std::get_if<Ellipsoid>(&geometry)) return length(Vec3d{p.x / e->x, p.y / e->y, p.z / e->z}) <= 1;
  if (const auto* h = std::get_if<Hull>(&geometry)) {
    std::vector<Vec3d> corners;
    for (const Vec3& v : h->data->vertices()) {
      corners.push_back({double{v.x} * h->scale.x, double{v.y} * h->scale.y, double{v.z} * h->scale.z});
    }
    return length(p - nearestInHull(p, corners)) <= h->rounding;
  }
  const auto* c = std::get_if<Capsule>(&geometry);
  const double y = clamped(p.y, -c->halfHeight, c->halfHeight);
  return c && length(Vec3d{p.x, p.y - y, p.z}) <= c->radius;
}

/// Midpoint rule over a grid of cells; every shape counts where it is, overlaps count twice.
struct Integral {
  double mass = 0;
  Vec3d center;
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

Integral integrate(const std::vector<ShapeDef>& shapes, double reach, int cells) {
  struct Sample {
    Vec3d p;
    double m;
  };
  std::vector<Sample> samples;
  Integral r;
  const double step = 2 * reach / cells;
  for (const ShapeDef& shape : shapes) {
    const Pose toShape = inverse(shape.pose);
    for (int i = 0; i < cells * cells * cells; ++i) {
      const Vec3d p{-reach + step * (i % cells + 0.5), -reach + step * (i / cells % cells + 0.5),
                    -reach + step * (i / cells / cells + 0.5)};
      const Vec3d local = toShape.position + rotate(toShape.rotation, p);
      if (inside(shape.geometry, local)) samples.push_back({p, shape.density * step * step * step});
    }
  }
  for (const Sample& s : samples) {
    r.mass += s.m;
    r.center = r.center + s.p * s.m;
  }
  r.center = r.center * (1 / r.mass);
  for (const Sample& s : samples) {
    const Vec3d d = s.p - r.center;
    r.xx += s.m * (d.y * d.y + d.z * d.z);
    r.yy += s.m * (d.x * d.x + d.z * d.z);
    r.zz += s.m * (d.x * d.x + d.y * d.y);
    r.xy -= s.m * d.x * d.y;
    r.xz -= s.m * d.x * d.z;
    r.yz -= s.m * d.y * d.z;
  }
  return r;
}

void expectSame(const MassProperties& m, const Integral& i, double relative) {
  const double size = i.xx + i.yy + i.zz;
  EXPECT_NEAR(m.mass, i.mass, relative * i.mass);
  EXPECT_NEAR(m.center.x, i.center.x, relative);
  EXPECT_NEAR(m.center.y, i.center.y, relative);
  EXPECT_NEAR(m.center.z, i.center.z, relative);
  EXPECT_NEAR(m.inertia.xx, i.xx, relative * size);
  EXPECT_NEAR(m.inertia.yy, i.yy, relative * size);
  EXPECT_NEAR(m.inertia.zz, i.zz, relative * size);
  EXPECT_NEAR(m.inertia.xy, i.xy, relative * size);
  EXPECT_NEAR(m.inertia.xz, i.xz, relative * size);
  EXPECT_NEAR(m.inertia.yz, i.yz, relative * size);
}

TEST(Mass, sphere) {
  const MassProperties m = massProperties(Sphere{0.5f}, 1000);
  EXPECT_FLOAT_EQ(m.mass, static_cast<float>(1000 * kPi / 6));
  EXPECT_FLOAT_EQ(m.inertia.xx, 0.1f * m.mass);
  EXPECT_EQ(m.inertia.xx, m.inertia.zz);
}

TEST(Mass, box) {
  const MassProperties m = massProperties(Box{0.5f, 1, 1.5f}, 2);
  EXPECT_FLOAT_EQ(m.mass, 12);
  EXPECT_FLOAT_EQ(m.inertia.xx, 12 * (1 + 2.25f) / 3);
  EXPECT_FLOAT_EQ(m.inertia.yy, 12 * (0.25f + 2.25f) / 3);
  EXPECT_FLOAT_EQ(m.inertia.zz, 12 * (0.25f + 1) / 3);
}

TEST(Mass, capsuleWithoutCylinderIsSphere) {
  const MassProperties a = massProperties(Capsule{0.5f, 0}, 1000), b = massProperties(Sphere{0.5f}, 1000);
  EXPECT_FLOAT_EQ(a.mass, b.mass);
  EXPECT_FLOAT_EQ(a.inertia.xx, b.inertia.xx);
  EXPECT_FLOAT_EQ(a.inertia.yy, b.inertia.yy);
}

TEST(Mass, capsuleAgainstIntegration) {
  const Capsule c{0.4f, 0.5f};
  expectSame(massProperties(c, 3), integrate({{.geometry = c, .density = 3}}, 0.95, 160), 2e-3);
}

TEST(Mass, halfSpaceHasNone) {
  EXPECT_EQ(massProperties(HalfSpace{}, 1000).mass, 0);
  const ShapeDef floor{.geometry = HalfSpace{}};
  const MassProperties m = massProperties(std::span(&floor, 1));
  EXPECT_EQ(m.mass, 0);
  EXPECT_EQ(m.inertia, SymMat3{});
  EXPECT_EQ(massProperties(std::span<const ShapeDef>{}).mass, 0);
}

TEST(Mass, halfSpaceAddsNothing) {
  const ShapeDef one{.geometry = Box{1, 1, 1}}, floor{.geometry = HalfSpace{}, .pose = {{7, 8, 9}, {}}};
  const ShapeDef both[] = {one, floor};
  const MassProperties a = massProperties(std::span(&one, 1)), b = massProperties(both);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.center, b.center);
  EXPECT_EQ(a.inertia, b.inertia);
}

TEST(Mass, sumsOfTurnedShapesAgainstIntegration) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit(0, 1);
  for (int round = 0; round < 6; ++round) {
    std::vector<ShapeDef> shapes;
    for (int i = 0; i < 3; ++i) {
      Quat q{normal(random), normal(random), normal(random), normal(random)};
      const float k = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
      q = {q.w * k, q.x * k, q.y * k, q.z * k};
      const Geometry all[] = {Sphere{0.3f}, Capsule{0.2f, 0.3f}, Box{0.2f, 0.3f, 0.4f}};
      shapes.push_back({.geometry = all[i],
                        .pose = {{unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5}, q},
                        .density = 1 + 9 * unit(random)});
    }
    expectSame(massProperties(shapes), integrate(shapes, 1.1, 120), 4e-3);
  }
}

TEST(Mass, farFromTheOriginLosesNothing) {
  std::vector<ShapeDef> shapes{{.geometry = Box{1, 2, 3}, .pose = {{1e6, -1e6, 1e6}, {}}}};
  const MassProperties far = massProperties(shapes), near = massProperties(Box{1, 2, 3}, 1000);
  EXPECT_EQ(far.inertia, near.inertia);
  EXPECT_EQ(far.center.x, 1e6f);
}

TEST(Mass, scalesExactlyByPowersOfTwo) {
  const Quat q{0.5f, 0.5f, -0.5f, 0.5f};
  std::vector<ShapeDef> small{{.geometry = Capsule{0.3f, 0.7f}, .pose = {{0.1, 0.2, 0.3}, q}},
                              {.geometry = Box{0.1f, 0.7f, 0.3f}, .pose = {{-0.4, 0.7, 0.1}, {}}}};
  std::vector<ShapeDef> big{{.geometry = Capsule{0.3f * 8, 0.7f * 8}, .pose = {Vec3d{0.1, 0.2, 0.3} * 8, q}},
                            {.geometry = Box{0.1f * 8, 0.7f * 8, 0.3f * 8}, .pose = {Vec3d{-0.4, 0.7, 0.1} * 8, {}}}};
  const MassProperties a = massProperties(small), b = massProperties(big);
  EXPECT_EQ(a.mass * 512, b.mass);
  EXPECT_EQ(a.center * 8, b.center);
  EXPECT_EQ(a.inertia.xy * 32768, b.inertia.xy);
  EXPECT_EQ(a.inertia.zz * 32768, b.inertia.zz);
}

TEST(Mass, angleOfIsTheAngle) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-3.14159, 3.14159), size(-20, 20);
  for (int i = 0; i < 10000; ++i) {
    const double a = any(random), r = std::exp2(size(random));
    EXPECT_NEAR(angleOf(r * std::cos(a), r * std::sin(a)), a, 2e-15 * kPi);
  }
  EXPECT_EQ(angleOf(1, 0), 0);
  EXPECT_NEAR(angleOf(0, 1), kPi / 2, 1e-15);
  EXPECT_NEAR(angleOf(-1, 0), kPi, 1e-15);
  EXPECT_NEAR(angleOf(1, 1e-12), 1e-12, 1e-27);
}

TEST(Mass, cylinderConeEllipsoid) {
  const float r = 0.3f, h = 0.7f;
  const double v = kPi * r * r * 2 * h;
  const MassProperties cylinder = massProperties(Cylinder{r, h}, 2);
  EXPECT_FLOAT_EQ(cylinder.mass, static_cast<float>(2 * v));
  EXPECT_FLOAT_EQ(cylinder.inertia.yy, cylinder.mass * r * r / 2);
  EXPECT_FLOAT_EQ(cylinder.inertia.xx, cylinder.mass * (3 * r * r + 4 * h * h) / 12);
  const MassProperties cone = massProperties(Cone{r, h}, 6);
  EXPECT_FLOAT_EQ(cone.mass, static_cast<float>(2 * v));
  EXPECT_FLOAT_EQ(cone.center.y, -h / 2);
  EXPECT_FLOAT_EQ(cone.inertia.yy, cone.mass * 0.3f * r * r);
  EXPECT_FLOAT_EQ(cone.inertia.zz, cone.mass * (0.15f * r * r + 3.0f / 80 * 4 * h * h));
  const MassProperties ellipsoid = massProperties(Ellipsoid{1, 2, 3}, 1);
  EXPECT_FLOAT_EQ(ellipsoid.mass, static_cast<float>(8 * kPi));
  EXPECT_FLOAT_EQ(ellipsoid.inertia.xx, ellipsoid.mass * 13 / 5);
}

TEST(Mass, everyShapeAgainstIntegration) {
  const std::vector<Vec3> points{
      {-0.3f, -0.3f, -0.2f}, {0.4f, -0.2f, -0.1f}, {0, 0.5f, 0}, {0.1f, -0.1f, 0.6f}, {0.3f, 0.3f, 0.3f}};
  const auto hull = makeHull({.points = points});
  const Geometry shapes[] = {Box{0.2f, 0.3f, 0.4f, 0.15f}, Cylinder{0.3f, 0.4f},
                             Cylinder{0.3f, 0.4f, 0.2f},   Cone{0.5f, 0.4f},
                             Cone{0.4f, 0.3f, 0.2f},       Ellipsoid{0.3f, 0.5f, 0.7f},
                             Hull{hull, {1, 1, 1}},        Hull{hull, {1.2f, -0.8f, 1}},
                             Hull{hull, {1, 1, 1}, 0.2f},  Hull{hull, {-1, 0.8f, 0.9f}, 0.1f}};
  for (size_t i = 0; i < std::size(shapes); ++i) {
    SCOPED_TRACE(i);
    // Turned, so that no side is in line with the samples.
    const std::vector<ShapeDef> turned{
        {.geometry = shapes[i], .pose = {{0.01, 0.02, -0.03}, {0.8f, 0.36f, -0.24f, 0.41569219f}}, .density = 3}};
    expectSame(massProperties(turned), integrate(turned, 0.95, 100), 2e-3);
  }
}

TEST(Mass, roundedShapesAgreeWhereTheyMeet) {
  // Without a core's extent a rounded shape is a ball; a thin one is a capsule.
  const MassProperties ball = massProperties(Sphere{0.5f}, 1000), capsule = massProperties(Capsule{0.5f, 1}, 1000);
  const auto expectNear = [](const MassProperties& a, const MassProperties& b, float relative) {
    EXPECT_NEAR(a.mass, b.mass, relative * b.mass);
    EXPECT_NEAR(a.inertia.xx, b.inertia.xx, relative * b.inertia.xx);
    EXPECT_NEAR(a.inertia.yy, b.inertia.yy, relative * b.inertia.xx);
    EXPECT_NEAR(a.inertia.zz, b.inertia.zz, relative * b.inertia.xx);
  };
  const float e = 1e-7f;
  expectNear(massProperties(Box{e, e, e, 0.5f}, 1000), ball, 1e-5f);
  expectNear(massProperties(Cylinder{e, e, 0.5f}, 1000), ball, 1e-5f);
  expectNear(massProperties(Cone{e, e, 0.5f}, 1000), ball, 1e-5f);
  expectNear(massProperties(Cylinder{e, 1, 0.5f}, 1000), capsule, 1e-5f);
  expectNear(massProperties(Cone{e, 1, 0.5f}, 1000), capsule, 1e-5f);
  expectNear(massProperties(Box{e, 1, e, 0.5f}, 1000), capsule, 1e-5f);
  // A box as a hull.
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 0.5f : -0.5f, i & 2 ? 0.25f : -0.25f, i & 4 ? 1.0f : -1.0f});
  const auto hull = makeHull({.points = corners});
  expectNear(massProperties(Hull{hull}, 7), massProperties(Box{0.5f, 0.25f, 1}, 7), 1e-6f);
  expectNear(massProperties(Hull{hull, {1, 1, 1}, 0.2f}, 7), massProperties(Box{0.5f, 0.25f, 1, 0.2f}, 7), 1e-6f);
}

TEST(Mass, roundedVolumesAreSteiners) {
  const double a = 0.5, b = 0.25, c = 1, r = 0.2;
  const double box =
      8 * a * b * c + 8 * r * (a * b + b * c + c * a) + 2 * kPi * r * r * (a + b + c) + 4 * kPi / 3 * r * r * r;
  EXPECT_NEAR(massProperties(Box{0.5f, 0.25f, 1, 0.2f}, 1).mass, box, 1e-6 * box);
  // Regular tetrahedron of edge sqrt 2: area 2 sqrt 3, angle between normals acos(-1/3).
  const std::vector<Vec3> points{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  const double l = std::sqrt(2.0), theta = std::acos(-1.0 / 3);
  const double tetrahedron = 1.0 / 3 + 2 * std::sqrt(3.0) * r + 6 * l * theta / 2 * r * r + 4 * kPi / 3 * r * r * r;
  EXPECT_NEAR(massProperties(Hull{makeHull({.points = points}), {1, 1, 1}, 0.2f}, 1).mass, tetrahedron,
              1e-6 * tetrahedron);
}

TEST(Mass, roundedHullByManyBalls) {
  // A cloud swept by a ball of small polyhedra: the hull of all vertices plus points of a dense sphere.
  const std::vector<Vec3> points = cloud(Cloud::Ball, 12, 4);
  const auto hull = makeHull({.points = points});
  std::vector<Vec3> swept;
  for (const Vec3& v : hull->vertices()) {
    for (const Vec3& u : cloud(Cloud::Sphere, 3000, 8)) swept.push_back(v + u * 0.3f);
  }
  const auto outer = makeHull({.points = swept, .tolerance = 1e-5f, .maxVertices = 255});
  const MassProperties a = massProperties(Hull{hull, {1, 1, 1}, 0.3f}, 1), b = outer->massProperties(1);
  EXPECT_NEAR(a.mass, b.mass, 0.02 * b.mass);
  EXPECT_GT(a.mass, b.mass);
  EXPECT_NEAR(a.center.x, b.center.x, 5e-3);
  EXPECT_NEAR(a.inertia.xy, b.inertia.xy, 0.03 * b.inertia.xx);
}

TEST(Mass, triggersWeighNothing) {
  const ShapeDef body{.geometry = Box{1, 1, 1}};
  const ShapeDef trigger{.geometry = Sphere{5}, .pose = {{9, 0, 0}, {}}, .isTrigger = true};
  const ShapeDef both[] = {body, trigger};
  EXPECT_EQ(massProperties(both).mass, massProperties(std::span(&body, 1)).mass);
  EXPECT_EQ(massProperties(both).center, Vec3{});
  EXPECT_EQ(massProperties(std::span(&trigger, 1)).mass, 0);
}

TEST(Mass, offCentreSolidsMoveAndTurnWithTheirPose) {
  const auto hull = makeHull({.points = cloud(Cloud::Ball, 40, 6)});
  const Quat q{0.5f, -0.5f, 0.5f, 0.5f};  // x -> y? an exact turn of axes
  const Geometry shapes[] = {Cone{0.4f, 0.5f, 0.1f}, Hull{hull, {1, 2, 0.5f}}};
  for (const Geometry& shape : shapes) {
    const MassProperties own = massProperties(shape, 5);
    const ShapeDef placed{.geometry = shape, .pose = {{3, -2, 1}, q}, .density = 5};
    const MassProperties moved = massProperties(std::span(&placed, 1));
    const Vec3 center = rotate(q, own.center) + Vec3{3, -2, 1};
    EXPECT_FLOAT_EQ(moved.mass, own.mass);
    EXPECT_NEAR(length(moved.center - center), 0, 1e-6);
    // I' v' . v' = I v . v for directions v.
    const auto along = [](const SymMat3& i, Vec3 v) {
      return i.xx * v.x * v.x + i.yy * v.y * v.y + i.zz * v.z * v.z +
             2 * (i.xy * v.x * v.y + i.xz * v.x * v.z + i.yz * v.y * v.z);
    };
    for (const Vec3 v : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}, Vec3{0, 1, -1}, Vec3{1, 2, 3}}) {
      EXPECT_NEAR(along(moved.inertia, rotate(q, v)), along(own.inertia, v), 1e-5 * along(own.inertia, v));
    }
  }
}

}  // namespace
}  // namespace avbd
