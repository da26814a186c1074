// GMSH files of both text versions, and broken ones.
#include "io/gmsh_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/mjcf.h"

namespace avbd {
namespace {

const std::string k22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"all\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n1 0 0 0\n2 1 0 0\n7 0 1 0\n4 0 0 1e0\n5 1 1 1\n$EndNodes\n"
    "$Elements\n3\n1 15 2 0 1 1\n2 4 2 0 1 1 2 7 4\n3 4 0 2 7 4 5\n$EndElements\n";
const std::string k41 =
    "$MeshFormat\r\n4.1 0 8\r\n$EndMeshFormat\r\n$Nodes\n2 4 1 4\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n"
    "3 1 0 1\n4\n\n1 1 0.5\n$EndNodes\n$Elements\n2 3 1 3\n1 1 1 1\n1 1 2\n2 1 2 2\n2 1 2 3\n3 2 4 3\n$EndElements\n";

std::string messageOf(const std::string& text) {
  try {
    readGmsh(text, "t.msh");
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

/// With one piece of it replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(GmshFile, Tetrahedra) {
  const GmshFile file = readGmsh(k22, "t.msh");
  EXPECT_EQ(file.dim, 3);
  ASSERT_EQ(file.points.size(), 5u);
  EXPECT_EQ(file.points[4], (Vec3{1, 1, 1}));
  ASSERT_EQ(file.elements.size(), 2u);
  EXPECT_EQ(file.elements[0], (std::array<uint32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(file.elements[1], (std::array<uint32_t, 4>{1, 2, 3, 4}));
}

TEST(GmshFile, Triangles) {
  const GmshFile file = readGmsh(k41, "t.msh");
  EXPECT_EQ(file.dim, 2);
  ASSERT_EQ(file.points.size(), 4u);
  EXPECT_EQ(file.points[3], (Vec3{1, 1, 0.5f}));
  ASSERT_EQ(file.elements.size(), 2u);
  EXPECT_EQ(file.elements[1], (std::array<uint32_t, 4>{1, 3, 2, 0}));
}

TEST(GmshFile, WhatIsNotReadSaysWhy) {
  EXPECT_EQ(readGmsh("$MeshFormat\n4.1 1 8\n\x01", "t.msh").leftOut, "binary");
  EXPECT_EQ(readGmsh("$MeshFormat\n4.0 0 8\n", "t.msh").leftOut, "version 4.0");
}

TEST(GmshFile, BrokenOnesAreRefusedWithTheirLine) {
  const std::pair<std::string, const char*> cases[] = {
      {"", "$MeshFormat is missing"},
      {"hello\nworld", "t.msh:2: $MeshFormat is missing"},
      {"$MeshFormat\n", "version is missing"},
      {"$MeshFormat\n2.2 0 8\n", "elements = 0: must have at least one triangle or tetrahedron"},
      {with(k22, "2 1 0 0", "2 1 0"), "t.msh:11: node is missing: must be a line of 4 numbers"},
      {with(k22, "2 1 0 0", "2 1 nan 0"), "t.msh:11: node = \"nan\": must be a number within 1e6"},
      {with(k22, "2 1 0 0", "2 1e9 0 0"), "node = \"1e9\""},
      {with(k22, "2 1 0 0", "1 1 0 0"), "node = \"1\": must not be given twice"},
      {with(k22, "2 1 0 0", "-2 1 0 0"), "node = \"-2\": must be a whole number >= 0"},
      {with(k22, "$Nodes\n5", "$Nodes\nx"), "count of nodes = \"x\": must be a whole number"},
      {with(k22, "1 1 2 7 4", "1 1 2 7 9"), "node of an element = \"9\": no node has this number"},
      {with(k22, "1 1 2 7 4", "1 1 2 7 7"), "node of an element = \"7\": must not be named twice"},
      {with(k22, "1 1 2 7 4", "1 1 2 7"), "an element of type 4 must have 4 nodes"},
      {with(k22, "2 4 2 0", "2 4 99 0"), "count of tags = \"99\": must be no more than the line has"},
      {with(k41, "2 1 0 3\n", "2 1 0 99\n"), "node = \"$EndNodes\": must be a whole number"},
      {with(k41, "2 1 2 3\n", "2 1 2\n"), "an element of type 2 must have 3 nodes"},
      {with(k41, "2 1 2 2\n", "2 1 2 9\n"), "element is missing"},
  };
  for (const auto& [text, part] : cases)
    EXPECT_NE(messageOf(text).find(part), std::string::npos) << messageOf(text) << "\n  lacks " << part;
}

TEST(GmshFile, EveryPrefixIsReadOrRefused) {
  for (const std::string& whole : {k22, k41})
    for (size_t size = 0; size < whole.size(); ++size) messageOf(whole.substr(0, size));
}

TEST(GmshFile, AFlexcompIsMadeOfIt) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "avbd_gmsh";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.msh") << k22;
  std::ofstream(folder / "b.msh") << with(k22, "2.2 0 8", "2.2 1 8");
  const auto model = [&](const char* file) {
    std::ofstream(folder / "m.xml")
        << "<mujoco><worldbody><flexcomp name='F' type='gmsh' dim='2' file='" << file
        << "' mass='5' scale='2 2 2'><elasticity young='1e4'/></flexcomp></worldbody></mujoco>";
    return readMjcf(folder / "m.xml");
  };
  const Model read = model("a.msh");
  const SoftId soft = read.world.softBodies().at(0);
  EXPECT_EQ(read.world.mesh(soft)->tets().size(), 2u);
  EXPECT_NEAR(read.world.volume(soft), 8 * (1.0 / 6 + 1.0 / 3), 1e-4);
  EXPECT_NEAR(read.world.mass(read.world.particles(soft)[0]), 1, 1e-6);
  const Model binary = model("b.msh");
  EXPECT_TRUE(binary.world.softBodies().empty());
  EXPECT_NE(binary.notes.at(0).find("binary"), std::string::npos) << binary.notes.at(0);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace avbd
