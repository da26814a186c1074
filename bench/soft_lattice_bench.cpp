// Time and quality of lattices of closed surfaces: `soft_lattice_bench [MESH CELL]...`, also of these mesh files.
#include <avbd/avbd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "io/mesh_file.h"
#include "src/geom/decompose_cases.h"

namespace avbd {
namespace {

/// Of the processor: a busy machine does not lengthen it.
double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double volumeOf(const TestMesh& surface) {
  double six = 0;
  for (const auto& t : surface.triangles) {
    const Vec3d a = toDouble(surface.vertices[t[0]]), b = toDouble(surface.vertices[t[1]]),
                c = toDouble(surface.vertices[t[2]]);
    six += dot(a, Vec3d{b.y * c.z - b.z * c.y, b.z * c.x - b.x * c.z, b.x * c.y - b.y * c.x});
  }
  return six / 6;
}

/// Box, turned so that no side of it lies along the lattice.
TestMesh turnedBox() {
  TestMesh box = boxMesh({0.5f, 0.35f, 0.25f});
  for (Vec3& v : box.vertices) v = rotate(Quat{0.8f, 0.3f, 0.4f, std::sqrt(0.11f)}, v);
  return box;
}

void row(const char* name, const TestMesh& surface, float cell, LatticeFit fit) {
  const SoftLatticeDef def{.points = surface.vertices, .triangles = surface.triangles, .cellSize = cell, .fit = fit};
  std::shared_ptr<const SoftMeshData> mesh;
  double took = 1e9;
  for (int i = 0; i < 3 && (i == 0 || took < 1); ++i) {
    const double start = now();
    mesh = makeTetLattice(def);
    took = std::min(took, now() - start);
  }
  const SoftMeshQuality q = qualityOf(*mesh);
  const double degree = 3.14159265358979 / 180, count = static_cast<double>(mesh->tets().size());
  std::printf("| %s, %g, %s | %zu | %zu | %.1f | %.2f | %.1f .. %.1f | %.2f | %.2f | %+.2f %% |\n", name, double{cell},
              fit == LatticeFit::Cover ? "cover" : "surface", mesh->tets().size(), mesh->points().size(), took * 1e3,
              took / count * 1e6, q.leastAngle / degree, q.greatestAngle / degree, q.leastRadiusRatio,
              q.leastHeight / double{cell}, 100 * (mesh->volume() / volumeOf(surface) - 1));
}

void rows(const char* name, const TestMesh& surface, float cell) {
  for (const float size : {cell, cell / 2, cell / 4}) row(name, surface, size, LatticeFit::Surface);
  row(name, surface, cell, LatticeFit::Cover);
}

}  // namespace
}  // namespace avbd

int main(int argc, char** argv) {
  using namespace avbd;
  std::printf(
      "| surface, cell [m], fit | tetrahedra | points | [ms] | [us] a tetrahedron | angles [degrees] | radius ratio | "
      "least height [of a cell] | volume |\n|---|---|---|---|---|---|---|---|---|\n");
  const TestMesh torus = torusMesh(0.5f, 0.2f, 48, 24);
  rows("torus", torus, 0.1f);
  row("torus", torus, 0.0125f, LatticeFit::Surface);
  rows("turned box", turnedBox(), 0.1f);
  rows("bowl", bowlMesh(), 0.08f);
  for (int i = 1; i + 1 < argc; i += 2) {
    const MeshFile file = readMeshFile(argv[i]);
    const std::string name = std::filesystem::path(argv[i]).filename().string();
    rows(name.c_str(), {file.vertices, file.triangles}, std::strtof(argv[i + 1], nullptr));
  }
  return 0;
}
