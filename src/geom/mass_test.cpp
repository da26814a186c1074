// Mass properties against closed forms and against integration by sampling.
#include "geom/mass.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace avbd {
namespace {

constexpr double kPi = 3.14159265358979323846;

bool inside(const Geometry& geometry, Vec3d p) {
  if (const auto* s = std::get_if<Sphere>(&geometry)) return length(p) <= s->radius;
  if (const auto* b = std::get_if<Box>(&geometry))
    return std::fabs(p.x) <= b->x && std::fabs(p.y) <= b->y && std::fabs(p.z) <= b->z;
  const auto* c = std::get_if<Capsule>(&geometry);
  const double y = std::fmax(-c->halfHeight, std::fmin(c->halfHeight, p.y));
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

}  // namespace
}  // namespace avbd
