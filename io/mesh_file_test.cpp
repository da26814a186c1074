// OBJ, STL and MSH: the same solid from each, and what real files do that the formats do not say.
#include "io/mesh_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <fstream>

namespace avbd {
namespace {

MeshFile read(const std::string& text, std::string_view kind) {
  return readMeshBytes(std::as_bytes(std::span(text)), kind, "t");
}

std::string messageOf(const std::string& text, std::string_view kind) {
  try {
    read(text, kind);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

double volumeOf(const MeshFile& mesh) {
  double out = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = toDouble(mesh.vertices[t[0]]), b = toDouble(mesh.vertices[t[1]]), c = toDouble(mesh.vertices[t[2]]);
    out += (a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x)) / 6;
  }
  return out;
}

std::string words(std::initializer_list<uint32_t> values) {
  std::string out;
  for (const uint32_t value : values) {
    for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i));
  }
  return out;
}

uint32_t bits(float value) { return std::bit_cast<uint32_t>(value); }

std::string triangleBytes(float size) {
  return words({0, 0, 0, 0, 0, 0, bits(size), 0, 0, 0, bits(size), 0}) + std::string(2, '\0');
}

const std::filesystem::path kGood = std::filesystem::path(__FILE__).parent_path() / "corpus/good";

TEST(MeshFile, TheSameSolidFromEveryKind) {
  const MeshFile cube = readMeshFile(kGood / "cube.obj");
  EXPECT_EQ(cube.vertices.size(), 8u);
  EXPECT_EQ(cube.triangles.size(), 12u);
  EXPECT_NEAR(volumeOf(cube), 1, 1e-12);
  EXPECT_TRUE(cube.notes.empty());
  for (const char* name : {"tetra.stl", "tetra_trailing.stl", "tetra_text.stl", "tetra.msh"}) {
    const MeshFile tetra = readMeshFile(kGood / name);
    EXPECT_EQ(tetra.vertices.size(), 4u) << name;
    EXPECT_EQ(tetra.triangles.size(), 4u) << name;
    EXPECT_NEAR(volumeOf(tetra), 1.0 / 3, 1e-7) << name;
  }
}

TEST(MeshFile, ObjCountsBackFromTheLastVertexSoFar) {
  const MeshFile mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -4/7 -1//3 -2/1/2\n", "obj");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], (std::array<uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (std::array<uint32_t, 3>{0, 3, 2}));
}

TEST(MeshFile, ObjMayUseVerticesBeforeTheyStandInTheFile) {
  EXPECT_EQ(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", "obj").triangles.size(), 1u);
}

TEST(MeshFile, ObjLinesEndInEveryWay) {
  const MeshFile mesh = read("v 0 0 0\r\nv 1 \\\r\n0 0\r\n\tv 0 1 0 # up\nf 1 2 \\\n 3", "obj");
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.vertices[1], (Vec3{1, 0, 0}));
  EXPECT_EQ(mesh.vertices[2], (Vec3{0, 1, 0}));
  // A line that goes on counts as two in messages.
  EXPECT_NE(messageOf("v 0 \\\n0 0\nv x", "obj").find("t:3: v.x = \"x\""), std::string::npos);
}

TEST(MeshFile, ObjByteOrderMarks) {
  const MeshFile mesh = read("\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "obj");
  EXPECT_EQ(mesh.vertices.size(), 3u);
  EXPECT_NE(messageOf(std::string("\xff\xfev\0 \0", 6), "obj").find("UTF-16"), std::string::npos);
}

TEST(MeshFile, ObjNotesWhatItDoesNotKnowOnce) {
  const MeshFile mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\nbevel on\nf 1 2 3\n", "obj");
  ASSERT_EQ(mesh.notes.size(), 2u);
  EXPECT_EQ(mesh.notes[0], "t:4: statement \"l\" is left out (and 1 more)");
}

TEST(MeshFile, NumbersBelowTheRangeAreZeroAndAboveItRefused) {
  EXPECT_EQ(read("v 0 0 0\nv 1e-400 1e-60 0\nv 0 1 0\nf 1 2 3\n", "obj").vertices[1], (Vec3{0, 0, 0}));
  EXPECT_NE(messageOf("v 1e400 0 0\nf 1 1 1\n", "obj").find("range of float"), std::string::npos);
}

TEST(MeshFile, BinaryStlMayBeginWithSolidAndHaveMoreBytes) {
  std::string bytes = "solid fake" + std::string(70, ' ') + words({1}) + triangleBytes(2);
  EXPECT_EQ(read(bytes, "stl").triangles.size(), 1u);
  EXPECT_TRUE(read(bytes, "stl").notes.empty());
  const MeshFile more = read(bytes + "tail", "stl");
  EXPECT_EQ(more.triangles.size(), 1u);
  ASSERT_EQ(more.notes.size(), 1u);
  EXPECT_EQ(more.notes[0], "t: 4 bytes after the last triangle are left out");
  bytes[80] = 2;
  EXPECT_NE(messageOf(bytes, "stl").find("number of triangles = 2: must be at most 1"), std::string::npos);
}

TEST(MeshFile, StlCornersOfOneValueAreOneVertex) {
  std::string bytes = std::string(80, 'x') + words({3}) + triangleBytes(1) + triangleBytes(2) + triangleBytes(1);
  const MeshFile mesh = read(bytes, "stl");
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.triangles[0], mesh.triangles[2]);
  // -0 is 0
  const std::string text =
      "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex -0 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  EXPECT_EQ(read(text, "stl").vertices.size(), 2u);
}

TEST(MeshFile, ManySolidsInOneTextAndWordsInAnyCase) {
  std::string text =
      "SOLID facet vertex\nFACET NORMAL 0 0 1\nOuter Loop\nVERTEX 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nENDFACET\nendsolid\n";
  EXPECT_EQ(read(text + text, "stl").triangles.size(), 2u);
}

TEST(MeshFile, StlUnderAnotherName) {
  const std::string bytes = "solid fake" + std::string(70, ' ') + words({1}) + triangleBytes(2);
  for (const char* kind : {"obj", "msh", "OBJ"}) {
    const MeshFile mesh = read(bytes, kind);
    EXPECT_EQ(mesh.triangles.size(), 1u) << kind;
    EXPECT_EQ(mesh.notes.size(), 1u) << kind;
  }
}

TEST(MeshFile, WhatIsNoFile) {
  const std::filesystem::path folder = testing::TempDir();
  EXPECT_THROW(readMeshFile(folder / "none.obj"), FileError);
  EXPECT_THROW(readMeshFile(folder), FileError);
  EXPECT_THROW(readMeshFile("/dev/zero"), FileError);
  EXPECT_NE(messageOf("v 0 0 0", "ply").find("kind = \"ply\": must be obj, stl or msh"), std::string::npos);
  const std::filesystem::path large = folder / "large.stl";
  std::ofstream(large).put('x');
  std::filesystem::resize_file(large, (uint64_t{64} << 20) + 1);
  try {
    readMeshFile(large);
    ADD_FAILURE();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("size = 67108865: must be at most 67108864"), std::string::npos)
        << error.what();
  }
  std::filesystem::remove(large);
}

}  // namespace
}  // namespace avbd
