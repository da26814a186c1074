// Soft meshes from closed surfaces (soft_lattice.h): what is refused, and the lattice about a surface.
#include <avbd/error.h>
#include <avbd/soft_lattice.h>

#include <algorithm>
#include <cmath>

#include "base/format.h"
#include "geom/decompose_surface.h"
#include "geom/lattice.h"
#include "geom/soft_mesh_parts.h"

namespace avbd {
namespace {

constexpr double kMostCubes = 500000;
constexpr double kLeastOfCoordinate = 1e-4;  // so that points of a cell stay apart as floats

[[noreturn]] void refuse(const char* field, std::string value, std::string range) {
  throw Error("SoftLatticeDef", field, std::move(value), std::move(range));
}

double part(Vec3d v, size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

void checkSurface(const ClosedSurface& surface, size_t triangles) {
  if (surface.size() == 0) refuse("triangles", toText(triangles) + " triangles", "must have at least one with area");
  if (const ClosedSurface::OpenEdges& open = surface.openEdges(); open.count > 0)
    refuse("triangles", toText(open.count) + " open edges, first " + open.first,
           "must form a closed surface: each edge of two triangles that agree about the outside");
  if (!(surface.volume() > 0))
    refuse("triangles", "a volume of " + toText(surface.volume()), "must be anticlockwise seen from outside");
}

/// Cubes along each axis that the surface's bounds need, to the nearest whole number: a box of whole cells is met
/// exactly.
std::array<double, 3> cubesOf(const ClosedSurface& surface, double cell) {
  std::array<double, 3> cubes;
  for (size_t i = 0; i < 3; ++i)
    cubes[i] = std::fmax(1, std::floor((part(surface.upper(), i) - part(surface.lower(), i)) / cell + 0.5));
  return cubes;
}

void checkCell(const SoftLatticeDef& def, const ClosedSurface& surface) {
  const auto no = [&](std::string range) { refuse("cellSize", toText(def.cellSize), std::move(range)); };
  if (!(def.cellSize > 0 && def.cellSize <= 1e6f)) no("must be finite and > 0 and at most 1e+06");
  double largest = 0, most = 1;
  for (size_t i = 0; i < 3; ++i) {
    largest = std::fmax(largest, std::fmax(std::fabs(part(surface.lower(), i)), std::fabs(part(surface.upper(), i))));
    most *= cubesOf(surface, double{def.cellSize})[i];
  }
  if (!(most <= kMostCubes))
    no("makes " + toText(static_cast<float>(most)) + " cubes of the surface's bounds, must be at most 500000");
  if (!(def.cellSize >= kLeastOfCoordinate * largest))
    no("must be at least " + toText(static_cast<float>(kLeastOfCoordinate * largest)) +
       ", 1e-4 of the largest coordinate");
}

/// A layer of cubes more on each side: the surface lies between middles of cubes.
Lattice latticeOf(const ClosedSurface& surface, double cell) {
  const std::array<double, 3> needed = cubesOf(surface, cell);
  std::array<int, 3> cubes;
  for (size_t i = 0; i < 3; ++i) cubes[i] = static_cast<int>(needed[i]) + 2;
  const Vec3d middle = (surface.lower() + surface.upper()) * 0.5;
  return {middle - Vec3d{cubes[0] * cell, cubes[1] * cell, cubes[2] * cell} * 0.5, cell, cubes};
}

/// Of the points that tetrahedra have, in the lattice's order.
std::shared_ptr<const SoftMeshData> softMeshOf(LatticeMesh mesh) {
  constexpr uint32_t kNone = 0xffffffffu;
  std::vector<uint32_t> place(mesh.points.size(), kNone);
  for (const auto& tet : mesh.tets)
    for (const uint32_t p : tet) place[p] = 0;
  std::vector<Vec3> points;
  for (size_t i = 0; i < place.size(); ++i) {
    if (place[i] == kNone) continue;
    place[i] = static_cast<uint32_t>(points.size());
    points.push_back(toFloat(mesh.points[i]));
  }
  for (auto& tet : mesh.tets)
    for (uint32_t& p : tet) p = place[p];
  return makeTetMesh({points, mesh.tets});
}

}  // namespace

std::shared_ptr<const SoftMeshData> makeTetLattice(const SoftLatticeDef& def) {
  soft_mesh::check("SoftLatticeDef", "triangles", def.points, def.triangles);
  if (def.fit != LatticeFit::Surface && def.fit != LatticeFit::Cover)
    refuse("fit", toText(static_cast<int>(def.fit)), "must be a value of LatticeFit");
  const ClosedSurface surface(def.points, def.triangles);
  checkSurface(surface, def.triangles.size());
  checkCell(def, surface);
  const Lattice lattice = latticeOf(surface, double{def.cellSize});
  const auto depth = [&](Vec3d p) {
    const ClosedSurface::Nearest nearest = surface.nearest(p);
    return nearest.behind ? nearest.distance : -nearest.distance;
  };
  LatticeMesh mesh = def.fit == LatticeFit::Cover ? coverLattice(lattice, depth) : cutLattice(lattice, depth);
  if (mesh.tets.empty())
    refuse("cellSize", toText(def.cellSize), "must be less: no tetrahedron of such cells lies in the solid");
  return softMeshOf(std::move(mesh));
}

}  // namespace avbd
