// Meshes and height fields of MJCF against formulas, and in the world.
#include "io/mjcf_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "io/mjcf.h"
#include "io/mjcf_mass.h"

namespace avbd::mjcf {
namespace {

// A box with these half extents about a centre.
MeshAsset boxMesh(Vec3d half, Vec3d center) {
  MeshAsset mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(center +
                            Vec3d{i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
  }
  const uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  mesh.solid = solidMass(mesh, true);
  mesh.shell = shellMass(mesh);
  return mesh;
}

void expectInertia(const Sym3d& a, const Sym3d& b) {
  for (const auto part : {&Sym3d::xx, &Sym3d::yy, &Sym3d::zz, &Sym3d::xy, &Sym3d::xz, &Sym3d::yz}) {
    EXPECT_NEAR(a.*part, b.*part, 1e-9 * (b.xx + b.yy + b.zz));
  }
}

TEST(MjcfMesh, ABoxHasTheMassOfABox) {
  const Vec3d half{1, 2, 3};
  for (const Vec3d center : {Vec3d{}, Vec3d{10, -20, 30}}) {
    const MeshAsset mesh = boxMesh(half, center);
    for (const bool exact : {false, true}) {
      const Mass mass = solidMass(mesh, exact);
      EXPECT_NEAR(mass.mass, 48, 1e-9);
      EXPECT_NEAR(length(mass.center - center), 0, 1e-12);
      expectInertia(mass.inertia, unitInertia(GeomKind::Box, half) * 48);
    }
  }
}

// Six plates: of each pair, area A at +-d, inertia about x: A (b^2 / 3 or d^2 ...).
TEST(MjcfMesh, ABoxOfPlates) {
  const double x = 1, y = 2, z = 3;
  const Mass shell = shellMass(boxMesh({x, y, z}, {5, 5, 5}));
  const double ax = 8 * y * z, ay = 8 * x * z, az = 8 * x * y;
  EXPECT_NEAR(shell.mass, ax + ay + az, 1e-9);
  EXPECT_NEAR(length(shell.center - Vec3d{5, 5, 5}), 0, 1e-12);
  const double xx = ax * x * x + (ay + az) * x * x / 3, yy = ay * y * y + (ax + az) * y * y / 3,
               zz = az * z * z + (ax + ay) * z * z / 3;
  expectInertia(shell.inertia, {yy + zz, xx + zz, xx + yy});
}

// Two boxes that overlap nowhere: signs make the exact integral additive, the legacy one counts too much.
TEST(MjcfMesh, ExactIsAdditive) {
  MeshAsset two = boxMesh({1, 1, 1}, {-3, 0, 0});
  const MeshAsset other = boxMesh({1, 1, 1}, {3, 1, 0});
  for (auto t : other.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
  const Mass exact = solidMass(two, true);
  EXPECT_NEAR(exact.mass, 16, 1e-9);
  EXPECT_NEAR(length(exact.center - Vec3d{0, 0.5, 0}), 0, 1e-12);
  const Mass parts[] = {{8, {-3, 0, 0}, unitInertia(GeomKind::Box, {1, 1, 1}) * 8},
                        {8, {3, 1, 0}, unitInertia(GeomKind::Box, {1, 1, 1}) * 8}};
  expectInertia(exact.inertia, sum(parts).inertia);
  EXPECT_GT(solidMass(two, false).mass, 17);
}

TEST(MjcfMesh, FittingABoxToABoxGivesItBack) {
  const MeshAsset mesh = boxMesh({3, 2, 1}, {1, 1, 1});
  Geom geom;
  geom.kind = GeomKind::Box;
  for (const bool around : {false, true}) {
    geom.pose = {};
    (around ? fitAround : fitToInertia)(mesh, geom);
    EXPECT_NEAR(length(geom.pose.position - Vec3d{1, 1, 1}), 0, 1e-12);
    const Sym3d turned = rotated(unitInertia(GeomKind::Box, geom.size), geom.pose.rotation);
    expectInertia(turned, unitInertia(GeomKind::Box, {3, 2, 1}));
  }
}

TEST(MjcfMesh, FittedAroundEveryVertexIsInside) {
  MeshAsset mesh = boxMesh({3, 2, 1}, {1, 1, 1});
  mesh.vertices[0] = {-4, -2, -1};  // no longer symmetric
  mesh.solid = solidMass(mesh, true);
  for (const GeomKind kind : {GeomKind::Sphere, GeomKind::Capsule, GeomKind::Cylinder, GeomKind::Box}) {
    Geom geom;
    geom.kind = kind;
    fitAround(mesh, geom);
    for (const Vec3d& v : mesh.vertices) {
      const Vec3d p = rotate(conjugate(geom.pose.rotation), v - geom.pose.position);
      const Vec3d s = geom.size;
      const double across = std::sqrt(p.x * p.x + p.y * p.y), past = std::max(0.0, std::abs(p.z) - s.y);
      double outside = 0;
      if (kind == GeomKind::Sphere) outside = length(p) - s.x;
      if (kind == GeomKind::Capsule) outside = std::sqrt(across * across + past * past) - s.x;
      if (kind == GeomKind::Cylinder) outside = std::max(across - s.x, past);
      if (kind == GeomKind::Box) outside = std::max({std::abs(p.x) - s.x, std::abs(p.y) - s.y, std::abs(p.z) - s.z});
      EXPECT_LE(outside, 1e-9) << static_cast<int>(kind);
    }
  }
}

Model read(const std::string& inside) { return readMjcfText("<mujoco>" + inside + "</mujoco>", "t.xml"); }

constexpr const char* kCube =
    "<mesh name='cube' vertex='-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1'/>";

TEST(MjcfMesh, AMeshBecomesAHullThatGeomsShare) {
  const Model model =
      read("<asset>" + std::string(kCube) +
           "</asset><worldbody><body><freejoint/><geom type='mesh' mesh='cube'/></body>"
           "<body pos='5 0 0'><freejoint/><geom type='mesh' mesh='cube' pos='1 2 3'/></body></worldbody>");
  const ShapeId a = model.world.shapes(model.bodies[0].id)[0], b = model.world.shapes(model.bodies[1].id)[0];
  const Hull hull = std::get<Hull>(model.world.geometry(a));
  EXPECT_EQ(hull.data->vertices().size(), 8u);
  EXPECT_EQ(hull.data, std::get<Hull>(model.world.geometry(b)).data);
  EXPECT_NEAR(model.world.mass(model.bodies[0].id), 8000, 0.1);
  EXPECT_EQ(model.world.localPose(b).position, (Vec3d{1, 2, 3}));
}

TEST(MjcfMesh, WhatOnlyShowsMayBeFlatAndWhatCollidesMayNot) {
  const std::string flat =
      "<asset><mesh name='f' vertex='0 0 0 1 0 0 0 1 0 1 1 0' face='0 1 2 1 3 2'/></asset><worldbody>";
  const Model model =
      read(flat + "<geom type='mesh' mesh='f' contype='0' conaffinity='0'/><geom size='1'/></worldbody>");
  EXPECT_EQ(model.world.shapeCount(), 1u);
  ASSERT_EQ(model.notes.size(), 1u);
  EXPECT_NE(model.notes[0].find("only for drawing, left out"), std::string::npos) << model.notes[0];
  EXPECT_THROW(read(flat + "<geom type='mesh' mesh='f'/></worldbody>"), FileError);
}

TEST(MjcfMesh, AFileThatNoGeomUsesIsNotRead) {
  EXPECT_EQ(
      read("<asset><mesh name='a' file='none.obj'/></asset><worldbody><geom size='1'/></worldbody>").world.shapeCount(),
      1u);
}

// nrow = 2 rows along y, the first written farthest; ncol = 3 columns along x; raised by z.
TEST(MjcfMesh, HeightsStandWhereTheyAreWritten) {
  const Model model = read(
      "<asset><hfield name='h' nrow='2' ncol='3' elevation='0 0 4  1 2 0' size='2 1 8 .5'/></asset>"
      "<worldbody><geom type='hfield' hfield='h' pos='0 0 1'/></worldbody>");
  const ShapeId shape = model.world.shapes(model.bodies[0].id)[0];
  const HeightField field = std::get<HeightField>(model.world.geometry(shape));
  EXPECT_FLOAT_EQ(field.data->thickness(), 8.5f);
  const Pose pose = model.world.localPose(shape);
  // In MJCF's frame: x -2, 0, 2 and y -1, 1.
  const double expected[2][3] = {{1, 2, 0}, {0, 0, 4}};
  for (int row = 0; row < field.data->rows(); ++row) {
    for (int column = 0; column < field.data->columns(); ++column) {
      const double x = (column - 0.5 * (field.data->columns() - 1)) * static_cast<double>(field.data->spacingX());
      const double z = (row - 0.5 * (field.data->rows() - 1)) * static_cast<double>(field.data->spacingZ());
      const Vec3d at = pose.position + rotate(pose.rotation, Vec3d{x, field.data->height(column, row), z});
      const int c = static_cast<int>(std::lround((at.x + 2) / 2)), r = static_cast<int>(std::lround((at.y + 1) / 2));
      ASSERT_TRUE(c >= 0 && c < 3 && r >= 0 && r < 2);
      EXPECT_NEAR(at.z, 1 + 2 * expected[r][c], 1e-5) << r << " " << c;
    }
  }
}

TEST(MjcfMesh, PngIsNotedAndItsGeomLeftOut) {
  const std::string folder = testing::TempDir();
  std::ofstream(folder + "h.png") << "no matter";
  std::ofstream(folder + "h.xml") << "<mujoco><asset><hfield file='h.png' size='1 1 1 1'/></asset><worldbody>"
                                     "<geom type='hfield' hfield='h'/></worldbody></mujoco>";
  const Model model = readMjcf(folder + "h.xml");
  EXPECT_EQ(model.world.shapeCount(), 0u);
  EXPECT_EQ(model.notes.size(), 2u);
}

}  // namespace
}  // namespace avbd::mjcf
