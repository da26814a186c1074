// Files of soft meshes: the same cube from every kind, what broken ones are told, and that none does harm.
#include "io/soft_mesh_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "io/mesh_file.h"

namespace avbd {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(__FILE__).parent_path() / "corpus" / "soft";

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

SoftMeshFile read(const std::string& text, std::string_view kind) {
  return readSoftMeshBytes(std::as_bytes(std::span(text)), kind, "t");
}

SoftMeshFile readPair(const std::string& node, const std::string& ele) {
  return readTetgenBytes(std::as_bytes(std::span(node)), std::as_bytes(std::span(ele)), "t");
}

template <class Read>
std::string messageOf(Read&& reading) {
  try {
    reading();
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

void expectTold(const std::string& text, std::string_view kind, const std::string& part) {
  const std::string said = messageOf([&] { read(text, kind); });
  EXPECT_NE(said.find(part), std::string::npos) << said;
}

/// The files were written by meshio 5.0; those of VTK 5.1 and with the other order of bytes follow the formats' texts.
TEST(SoftMeshFile, TheSameCubeFromEveryKind) {
  size_t count = 0;
  for (const auto& entry : fs::directory_iterator(kCorpus)) {
    const fs::path& file = entry.path();
    ++count;
    EXPECT_TRUE(isSoftMeshFile(file)) << file;
    const SoftMeshFile mesh = readSoftMeshFile(file);
    EXPECT_EQ(mesh.points.size(), 8u) << file;
    EXPECT_EQ(mesh.tets.size(), 5u) << file;
    const bool isTetgen = file.extension() == ".node" || file.extension() == ".ele";
    EXPECT_EQ(mesh.triangles.size(), isTetgen ? 0u : 2u) << file;
    ASSERT_EQ(mesh.notes.size(), isTetgen ? 0u : 1u) << file;
    if (!isTetgen) {
      EXPECT_EQ(mesh.notes[0], file.string() + ": 1 lines are left out");
    }
    const auto soft = makeSoftMesh(mesh, "t");
    EXPECT_NEAR(soft->volume(), 1, 1e-6) << file;
    EXPECT_EQ(soft->points()[5], (Vec3{1, 0, 1})) << file;
    EXPECT_EQ(soft->report().duplicate + soft->report().degenerate, 0u) << file;
  }
  EXPECT_EQ(count, 11u);
}

TEST(SoftMeshFile, CutOrDamagedFilesAreRefusedOrSound) {
  for (const auto& entry : fs::directory_iterator(kCorpus)) {
    const std::string kind = entry.path().extension().string().substr(1), whole = contentOf(entry.path());
    if (kind == "node" || kind == "ele") continue;
    size_t refused = 0;
    for (size_t i = 0; i < whole.size(); ++i) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] + 7 + static_cast<char>(i % 100));
      for (const std::string& text : {whole.substr(0, i), damaged}) {
        try {
          const SoftMeshFile mesh = read(text, kind);
          for (const auto& tet : mesh.tets)
            for (const uint32_t p : tet) ASSERT_LT(p, mesh.points.size());
        } catch (const FileError& error) {
          ++refused;
          EXPECT_TRUE(std::string_view(error.what()).starts_with("t: ") ||
                      std::string_view(error.what()).starts_with("t:"))
              << error.what();
        }
      }
    }
    EXPECT_GT(refused, whole.size() / 2) << entry.path();
  }
}

const std::string kHead = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kNodes = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n5 0 1 0\n9 0 0 1\n$EndNodes\n";

TEST(SoftMeshFile, BrokenGmshFilesAreToldByLine) {
  expectTold("", "msh", "t: the file is empty");
  expectTold("solid", "msh", "t: must begin with $MeshFormat");
  expectTold("$MeshFormat\n3 0 8\n", "msh", "t:2: version = \"3\": must be 2.2 or 4.1");
  expectTold("$MeshFormat\n2.2 2 8\n", "msh", "t:2: file type = \"2\": must be a whole number of 0 .. 1");
  expectTold("$MeshFormat\n2.2 1 4\n", "msh", "data size = \"4\": must be a whole number of 8 .. 8");
  expectTold(kHead, "msh", "$Nodes is missing");
  expectTold(kHead + kNodes, "msh", "tetrahedra and triangles = 0: must be at least 1");
  expectTold(kHead + kNodes + kNodes, "msh", "t:11: $Nodes: must not stand twice");
  expectTold(kHead + "$Nodes\n900\n", "msh", "t:5: number of nodes = \"900\": must be a whole number of 0 .. ");
  expectTold(kHead + "$Nodes\n1\n1 0 nan 0\n", "msh", "t:6: y = \"nan\": must be a finite number");
  expectTold(kHead + "$Nodes\n2\n3 0 0 0\n3 0 0 0\n$EndNodes", "msh", "node = \"3\": must not stand twice");
  expectTold(kHead + "$Elements\n0\n$EndElements", "msh", "$Elements: $Nodes must stand before it");
  expectTold(kHead + kNodes + "$Elements\n1\n1 4 0 1 2 5 8\n$EndElements", "msh",
             "t:13: node of an element = \"8\": must be one of the file's nodes");
  expectTold(kHead + kNodes + "$Elements\n1\n1 77 0 1 2 5 8\n$EndElements", "msh",
             "t:13: type of an element = \"77\": must be 1 .. 31, 92 or 93");
  expectTold(kHead + kNodes + "$Elements\n1\n1 4 0 1 2 5 9\n$EndNodes", "msh",
             "statement = \"$EndNodes\": must be $EndElements");
  expectTold(kHead + "$Comments\nnothing", "msh", "$EndComments is missing");
}

TEST(SoftMeshFile, ElementsOfSecondOrderAreTakenByTheirCorners) {
  const SoftMeshFile mesh = read(
      kHead + kNodes + "$Elements\n3\n1 11 2 7 7 1 2 5 9 1 1 1 1 1 1\n2 15 0 9\n3 9 1 0 1 2 5 9 9 9\n$EndElements\n",
      "msh");
  ASSERT_EQ(mesh.tets.size(), 1u);
  EXPECT_EQ(mesh.tets[0], (std::array<uint32_t, 4>{0, 1, 2, 3}));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  ASSERT_EQ(mesh.notes.size(), 3u);
  EXPECT_EQ(mesh.notes[0], "t: 1 triangles of 6 nodes are taken by their corners");
  EXPECT_EQ(mesh.notes[1], "t: 1 tetrahedra of 10 nodes are taken by their corners");
  EXPECT_EQ(mesh.notes[2], "t: 1 points are left out");
}

TEST(SoftMeshFile, BrokenVtkFilesAreToldByLine) {
  const std::string head = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  const std::string points = "POINTS 4 float\n0 0 0 1 0 0\n0 1 0 0 0 1\n";
  expectTold("vtk", "vtk", "first line = \"vtk\": must be # vtk DataFile Version and a number");
  expectTold("# vtk DataFile Version 3.0\n\nXML", "vtk", "t:3: kind = \"XML\": must be ASCII or BINARY");
  expectTold("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n", "vtk",
             "DATASET = \"POLYDATA\": must be UNSTRUCTURED_GRID");
  expectTold(head, "vtk", "POINTS is missing");
  expectTold(head + "POINTS 1 string\n0 0 0\n", "vtk", "type of points = \"string\": must be float or double");
  expectTold(head + points, "vtk", "tetrahedra and triangles = 0");
  expectTold(head + points + "CELLS 1 5\n4 0 1 2 3\n", "vtk", "number of CELL_TYPES = \"0\": must be 1");
  expectTold(head + points + "CELLS 1 5\n5 0 1 2 3\n", "vtk", "t:9: number of points of a cell = \"5\"");
  expectTold(head + points + "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n", "vtk",
             "point of cell 0 = \"4\": must be < 4, the points");
  expectTold(head + points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n10\n", "vtk",
             "number of points of cell 0 = \"3\": must be 4");
  expectTold(head + points + "CELLS 2 4\nOFFSETS vtktypeint64\n0 9\n", "vtk", "offset = \"9\"");
  expectTold(head + "CELLSS", "vtk", "statement = \"CELLSS\": must be POINTS");
  const SoftMeshFile mesh = read(head + points + "CELLS 2 8\n4 0 1 2 3 2 0 1\nCELL_TYPES 2\n10 99\n", "vtk");
  EXPECT_EQ(mesh.tets.size(), 1u);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0], "t: 1 cells of other kinds are left out");
}

TEST(SoftMeshFile, TetgenNumbersFromAnywhereAndIsToldByLine) {
  const std::string node = "# points\n4 3 1 1\n1 0 0 0 7 1\n2 1 0 0 7 1\n3 0 1 0 7 1 # the third\n4 0 0 1 7 1\n";
  const SoftMeshFile mesh = readPair(node, "1 4 1\n1 1 2 3 4 5\n");
  ASSERT_EQ(mesh.tets.size(), 1u);
  EXPECT_EQ(mesh.tets[0], (std::array<uint32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.points[2], (Vec3{0, 1, 0}));
  const auto told = [&](const std::string& nodes, const std::string& ele) {
    return messageOf([&] { readPair(nodes, ele); });
  };
  EXPECT_EQ(told(node, "1 4 0\n1 1 2 3 0\n"), "t.ele:2: node of an element = \"0\": must be one of the file's nodes");
  EXPECT_EQ(told("4 2 0 0\n", "1 4 0\n1 1 2 3 4\n").substr(0, 24), "t.node:1: number of poin");
  EXPECT_EQ(told("1 2 0 0\n1 0 0 0\n", "1 4 0\n1 1 2 3 4\n"),
            "t.node:1: dimension = \"2\": must be a whole number of 3 .. 3");
  EXPECT_EQ(told(node, "1 6 0\n1 1 2 3 4 4 4\n"), "t.ele:1: nodes of a tetrahedron = \"6\": must be 4 or 10");
  EXPECT_EQ(told(node, ""), "t.ele: the file is empty");
  EXPECT_EQ(readPair(node, "1 10 0\n1 1 2 3 4 1 1 1 1 1 1\n").notes.size(), 1u);
}

TEST(SoftMeshFile, KindsAreToldApart) {
  EXPECT_FALSE(isSoftMeshFile("a.obj"));
  EXPECT_FALSE(isSoftMeshFile("nothing.msh"));
  EXPECT_FALSE(isSoftMeshFile(kCorpus.parent_path() / "good" / "tetra.msh"));
  EXPECT_EQ(messageOf([] { readSoftMeshFile("nothing.vtk"); }), "nothing.vtk: no such file");
  EXPECT_EQ(messageOf([] { readSoftMeshFile("a.obj"); }),
            "a.obj: extension = \".obj\": must be .msh, .vtk, .node or .ele");
  const std::string gmsh = messageOf([] { readMeshFile(kCorpus / "cube_22_text.msh"); });
  EXPECT_NE(gmsh.find("is a Gmsh mesh, a soft body's: must be MuJoCo's MSH"), std::string::npos) << gmsh;
}

TEST(SoftMeshFile, TrianglesAloneAreCloth) {
  const SoftMeshFile mesh = read(kHead + kNodes + "$Elements\n1\n1 2 0 1 2 5\n$EndElements\n", "msh");
  EXPECT_TRUE(makeSoftMesh(mesh, "t")->isCloth());
  const SoftMeshFile flat = read(kHead + kNodes + "$Elements\n1\n1 4 0 1 2 5 5\n$EndElements\n", "msh");
  const std::string said = messageOf([&] { makeSoftMesh(flat, "t"); });
  EXPECT_NE(said.find("t: TetMeshDef.tets"), std::string::npos) << said;
}

}  // namespace
}  // namespace avbd
