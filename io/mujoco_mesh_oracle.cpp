// Meshes and height fields against MuJoCo: hulls, masses, fitted primitives, heights.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <random>

#include "io/mjcf_build.h"
#include "io/mujoco_compare.h"

namespace avbd::mjcf {
namespace {

std::string bytesOf(const auto& values) {
  std::string out;
  for (const auto value : values) {
    const uint32_t bits = std::bit_cast<uint32_t>(value);
    for (int i = 0; i < 4; ++i) out += static_cast<char>(bits >> (8 * i));
  }
  return out;
}

// A wedge with no symmetry, its corner cut off.
const std::vector<Vec3> kPoints = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 3}, {1.5f, 0.1f, 0.2f}};
const std::vector<std::array<uint32_t, 3>> kFaces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}};
// A U of three boxes side by side, not convex, as one closed surface: 8 corners of the outline at two heights.
const std::vector<Vec3> kOutline = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {2, 2, 0},
                                    {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};

std::string objOf(const std::vector<Vec3>& points, const std::vector<std::array<uint32_t, 3>>& faces) {
  std::string out = "# test\no thing\n";
  for (const Vec3 v : points) {
    out += "v " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  }
  for (const auto& f : faces) {
    out += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " + std::to_string(f[2] + 1) + "\n";
  }
  return out;
}

std::string stlOf(const std::vector<Vec3>& points, const std::vector<std::array<uint32_t, 3>>& faces) {
  std::string out = "solid but binary" + std::string(64, ' ');
  out += bytesOf(std::vector<uint32_t>{static_cast<uint32_t>(faces.size())});
  for (const auto& f : faces) {
    std::vector<float> numbers(3, 0.0f);
    for (const uint32_t i : f) numbers.insert(numbers.end(), {points[i].x, points[i].y, points[i].z});
    out += bytesOf(numbers) + std::string(2, '\0');
  }
  return out;
}

std::string mshOf(const std::vector<Vec3>& points, const std::vector<std::array<uint32_t, 3>>& faces) {
  std::vector<uint32_t> words = {static_cast<uint32_t>(points.size()), 0, 0, static_cast<uint32_t>(faces.size())};
  for (const Vec3 v : points) {
    for (const float f : {v.x, v.y, v.z}) words.push_back(std::bit_cast<uint32_t>(f));
  }
  for (const auto& f : faces) words.insert(words.end(), f.begin(), f.end());
  return bytesOf(words);
}

void writeMeshes() {
  write(objOf(kPoints, kFaces), "wedge.obj");
  write(stlOf(kPoints, kFaces), "wedge_stl.stl");
  write(mshOf(kPoints, kFaces), "wedge_msh.msh");
  write(mshOf(kPoints, {}), "points.msh");
  std::vector<Vec3> points = kOutline;
  for (const Vec3 v : kOutline) points.push_back({v.x, v.y, 0.7f});
  std::vector<std::array<uint32_t, 3>> faces;
  const std::array<uint32_t, 3> flat[] = {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}};
  for (const auto& t : flat) {
    faces.push_back({t[0], t[2], t[1]});
    faces.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  }
  for (uint32_t i = 0; i < 8; ++i) {
    const uint32_t k = (i + 1) % 8;
    faces.push_back({i, k, k + 8});
    faces.push_back({i, k + 8, i + 8});
  }
  write(objOf(points, faces), "u.obj");
}

// Shells are left out: MuJoCo 2.2 computes their frame after it has moved the vertices to that of the solid. They are
// tested against formulas.
class Meshes : public testing::TestWithParam<const char*> {};

TEST_P(Meshes, GiveTheSameBodies) {
  writeMeshes();
  const std::string exact = "<mujoco><compiler exactmeshinertia='true'/>";
  compare(write(exact + GetParam() + "</mujoco>"));
  compare(write(std::string("<mujoco>") + GetParam() + "</mujoco>"), MeshWeight::BoxOfInertia);
}

INSTANTIATE_TEST_SUITE_P(
    Mjcf, Meshes,
    testing::Values(
        // every kind of file, placed and weighed
        R"(<asset><mesh file="wedge.obj"/><mesh name="s" file="wedge_stl.stl"/><mesh file="wedge_msh.msh"/></asset>
           <worldbody><body pos="1 2 3" euler="10 20 30"><freejoint/><geom type="mesh" mesh="wedge"/></body>
           <body><freejoint/><geom type="mesh" mesh="s" pos="1 2 3" euler="30 0 40" density="500"/></body>
           <body><freejoint/><geom type="mesh" mesh="wedge_msh" friction="1 .2 .3" condim="6"/></body></worldbody>)",
        // inline, with and without faces, shared by geoms
        R"(<asset><mesh name="a" vertex="0 0 0 1 0 0 0 1 0 0 0 2" face="0 2 1 0 1 3 0 3 2 1 2 3"/>
           <mesh name="b" vertex="0 0 0 1 0 0 0 1 0 0 0 1 1 1 1 .2 .2 .2"/></asset><worldbody>
           <body><freejoint/><geom type="mesh" mesh="a"/><geom type="mesh" mesh="a" pos="0 1 2" zaxis="1 1 0"/></body>
           <body><freejoint/><geom type="mesh" mesh="b" euler="10 20 30"/></body></worldbody>)",
        R"(<asset><mesh file="points.msh"/></asset><worldbody><body><freejoint/><geom type="mesh" mesh="points"/></body>
           </worldbody>)",
        // refpos, refquat, scale, by class; mirrored
        R"(<default><mesh scale=".1 .2 .3"/><default class="m"><mesh scale="-1 2 1"/></default></default>
           <asset><mesh name="a" file="wedge.obj" refpos="1 2 3" refquat="1 2 0 1"/><mesh name="b" class="m" file="wedge.obj"/></asset>
           <worldbody><body><freejoint/><geom type="mesh" mesh="a" pos="3 0 0" euler="0 90 0"/></body>
           <body><freejoint/><geom type="mesh" mesh="b"/></body></worldbody>)",
        // not convex: pyramids of either sign
        R"(<asset><mesh file="u.obj"/></asset><worldbody><body><freejoint/><geom type="mesh" mesh="u"/></body></worldbody>)",
        // primitives fitted to meshes, by inertia and around them
        R"(<asset><mesh file="wedge.obj"/></asset><worldbody>
           <body><freejoint/><geom type="box" mesh="wedge" pos="1 2 3" euler="10 20 30"/></body>
           <body><freejoint/><geom type="sphere" mesh="wedge"/></body><body><freejoint/><geom type="capsule" mesh="wedge"/></body>
           <body><freejoint/><geom type="cylinder" mesh="wedge" fitscale=".5"/></body>
           <body><freejoint/><geom type="ellipsoid" mesh="wedge" density="10"/></body></worldbody>)"));

// MuJoCo 2.2 leaves out the mesh's own centre when it places a shape fitted around it; its sizes are right.
TEST(MeshOracle, ShapesAroundMeshes) {
  writeMeshes();
  const std::string file = write(
      R"(<mujoco><compiler fitaabb="true" exactmeshinertia="true"/><asset><mesh file="wedge.obj"/></asset><worldbody>
      <body><freejoint/><geom type="box" mesh="wedge" pos="1 2 3" euler="10 20 30"/>
      <geom type="sphere" mesh="wedge"/><geom type="capsule" mesh="wedge"/><geom type="cylinder" mesh="wedge" fitscale=".5"/>
      <geom type="ellipsoid" mesh="wedge" density="10"/></body></worldbody></mujoco>)");
  const Loaded mj = load(file);
  ASSERT_TRUE(mj.model) << mj.error;
  const Description d = parseFile(file);
  const std::vector<Geom>& geoms = d.bodies[1].geoms;
  ASSERT_EQ(mj.model->ngeom, 5);
  for (size_t g = 0; g < 5; ++g) {
    const mjtNum* s = mj.model->geom_size + 3 * g;
    mjtNum used[3] = {s[0], geoms[g].size.y > 0 ? s[1] : 0, geoms[g].size.z > 0 ? s[2] : 0};
    expectNear(geoms[g].size, used, 1e-5, geoms[g].where);
  }
}

TEST(MeshOracle, FoldersOfMeshes) {
  writeMeshes();
  std::filesystem::create_directories(folder() + "/deep/er");
  write(objOf(kPoints, kFaces), "deep/er/a.obj");
  for (const std::string head :
       {R"(<compiler meshdir="deep"/><asset><mesh file="er/a.obj"/></asset>)",
        R"(<compiler meshdir="deep/er"/><asset><mesh file="../er/a.obj"/></asset>)",
        R"(<compiler strippath="true" meshdir="deep/er"/><asset><mesh file="/no/such/a.obj"/></asset>)"}) {
    SCOPED_TRACE(head);
    compare(write("<mujoco>" + head +
                  R"(<worldbody><body><freejoint/><geom type="mesh" mesh="a" mass="3"/></body></worldbody></mujoco>)"));
  }
  compare(write("<mujoco><asset><mesh file='" + folder() +
                R"(/deep/er/a.obj'/></asset><worldbody><body><freejoint/>
      <geom type="mesh" mesh="a" mass="3"/></body></worldbody></mujoco>)"));
}

TEST(MeshOracle, HeightFields) {
  std::vector<float> heights;
  for (int i = 0; i < 12; ++i) heights.push_back(0.3f * static_cast<float>(i * i % 7) - 1);
  write(bytesOf(std::vector<uint32_t>{3, 4}) + bytesOf(heights), "hills.bin");
  const std::string file = write(R"(<mujoco><asset><hfield name="a" file="hills.bin" size="2 3 .5 .1"/>
      <hfield name="flat" nrow="2" ncol="3" size="1 1 1 1"/></asset>
      <default><geom contype="0" conaffinity="0"/></default><worldbody>
      <body pos="1 2 3" euler="0 0 30"><geom type="hfield" hfield="a" pos="0 1 0" euler="10 0 0"/></body>
      <geom type="hfield" hfield="flat"/></worldbody></mujoco>)");
  compare(file);
  const Loaded mj = load(file);
  ASSERT_TRUE(mj.model) << mj.error;
  const Description d = parseFile(file);
  const mjModel* m = mj.model.get();
  for (int id = 0; id < 2; ++id) {
    const HeightAsset& ours = d.heights[static_cast<size_t>(id)];
    ASSERT_EQ(m->hfield_nrow[id], ours.rows);
    ASSERT_EQ(m->hfield_ncol[id], ours.columns);
    const mjtNum size[] = {ours.radius.x, ours.radius.y, ours.radius.z, ours.base};
    for (int k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(size[k], m->hfield_size[4 * id + k]);
    for (size_t i = 0; i < ours.heights.size(); ++i) {
      EXPECT_NEAR(ours.heights[i], m->hfield_data[m->hfield_adr[id] + static_cast<int>(i)], 1e-6) << i;
    }
  }
}

// Rays from above find the same ground as our field has.
TEST(MeshOracle, HeightFieldsStandWhereTheirsDo) {
  std::vector<float> heights;
  for (int i = 0; i < 30; ++i) heights.push_back(static_cast<float>((i * 37) % 11));
  write(bytesOf(std::vector<uint32_t>{5, 6}) + bytesOf(heights), "hills.bin");
  const std::string file =
      write(R"(<mujoco><asset><hfield name="a" file="hills.bin" size="2 3 .5 .1"/></asset><worldbody>
      <geom type="hfield" hfield="a" pos=".1 .2 .3" euler="0 0 20"/></worldbody></mujoco>)");
  const Loaded mj = load(file);
  ASSERT_TRUE(mj.model) << mj.error;
  const Description d = parseFile(file);
  Notes notes;
  GeomShapes shapes(d, notes);
  const auto shape = shapes.shape(d.bodies[0].geoms[0]);
  const HeightFieldData& field = *std::get<HeightField>(shape->geometry).data;
  const Posed pose = d.bodies[0].geoms[0].pose * Posed{{}, shape->turn};
  size_t hits = 0;
  for (uint32_t t = 0; t < field.triangleCount(); ++t) {
    const auto corners = field.triangle(t);
    // Three points inside each triangle: they lie on MuJoCo's surface only if the cells are cut the same way.
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 inside = corners[k] * 0.6f + corners[(k + 1) % 3] * 0.2f + corners[(k + 2) % 3] * 0.2f;
      const Vec3d at = (pose * Posed{toDouble(inside), {}}).position;
      const mjtNum from[3] = {at.x, at.y, 10}, down[3] = {0, 0, -1};
      const mjtNum distance = mj_rayHfield(mj.model.get(), mj.data.get(), 0, from, down);
      EXPECT_NEAR(10 - distance, at.z, 1e-5) << "triangle " << t;
      hits += distance > 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(hits, size_t{4 * 5 * 2 * 3});
}

// Random blobs: convex or not, open or not, MuJoCo's integral must come out.
TEST(MeshOracle, RandomMeshes) {
  std::mt19937 random(7);
  const auto number = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(random() % 100000) / 100000;
  };
  for (int round = 0; round < 40; ++round) {
    // A sphere of rings with uneven radii.
    const uint32_t rings = 3 + static_cast<uint32_t>(random() % 4), sides = 3 + static_cast<uint32_t>(random() % 5);
    std::vector<Vec3> points;
    std::vector<std::array<uint32_t, 3>> faces;
    for (uint32_t r = 0; r <= rings; ++r) {
      for (uint32_t s = 0; s < sides; ++s) {
        const double along = 3.14159265 * r / rings, turn = 6.2831853 * s / sides, size = number(0.5, 1.5);
        points.push_back({static_cast<float>(1 + size * std::sin(along) * std::cos(turn)),
                          static_cast<float>(2 * size * std::sin(along) * std::sin(turn)),
                          static_cast<float>(size * std::cos(along))});
      }
    }
    for (uint32_t r = 0; r < rings; ++r) {
      for (uint32_t s = 0; s < sides; ++s) {
        const uint32_t a = r * sides + s, b = r * sides + (s + 1) % sides;
        faces.push_back({a, a + sides, b});
        faces.push_back({b, a + sides, b + sides});
      }
    }
    write(mshOf(points, faces), "blob.msh");
    SCOPED_TRACE(round);
    compare(
        write(R"(<mujoco><asset><mesh file="blob.msh" scale="1 .5 2"/></asset><worldbody><body pos="1 2 3"><freejoint/>
        <geom type="mesh" mesh="blob" pos=")" +
              std::to_string(number(-1, 1)) + R"( 2 1" euler="10 20 70" mass="3"/></body>
        <body><freejoint/><geom type="ellipsoid" mesh="blob"/></body></worldbody></mujoco>)"));
    if (HasFailure()) break;
  }
}

}  // namespace
}  // namespace avbd::mjcf
