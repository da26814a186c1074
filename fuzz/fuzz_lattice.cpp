// Lattices of surfaces, closed ones that cross themselves and broken ones: refused by name, or of sound tetrahedra.
#include <avbd/error.h>
#include <avbd/soft_binding.h>
#include <avbd/soft_lattice.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fuzz/bytes.h"
#include "fuzz/check.h"

namespace avbd::fuzz {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

struct Surface {
  std::vector<Vec3> points;
  std::vector<std::array<uint32_t, 3>> triangles;
};

Surface tetrahedron() {
  return {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

Surface box() {
  Surface s;
  for (int i = 0; i < 8; ++i) s.points.push_back({i & 1 ? 2.0f : -2.0f, i & 2 ? 2.0f : -2.0f, i & 4 ? 2.0f : -2.0f});
  const uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    s.triangles.push_back({q[0], q[1], q[2]});
    s.triangles.push_back({q[0], q[2], q[3]});
  }
  return s;
}

Surface surfaceOf(Bytes& in) {
  Surface s;
  for (uint32_t count = 1 + in.below(3); count > 0; --count) {
    const Surface part = in.flag() ? box() : tetrahedron();
    const uint32_t first = static_cast<uint32_t>(s.points.size());
    const Vec3 at = in.flag() ? in.vector() : Vec3{};
    for (const Vec3 p : part.points) s.points.push_back(p + at);
    for (const auto& t : part.triangles) s.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  // Points moved, and sometimes triangles that are none.
  for (uint32_t moves = in.below(16); moves > 0; --moves)
    s.points[in.below(static_cast<uint32_t>(s.points.size()))] = in.vector();
  for (uint32_t spoilt = in.below(8) == 7 ? in.below(4) : 0; spoilt > 0; --spoilt)
    s.triangles[in.below(static_cast<uint32_t>(s.triangles.size()))][in.below(3)] = in.byte();
  return s;
}

struct Bounds {
  Vec3 lower, upper;
};

Bounds boundsOf(std::span<const Vec3> points) {
  Bounds b{points[0], points[0]};
  for (const Vec3 p : points) {
    b.lower = {std::min(b.lower.x, p.x), std::min(b.lower.y, p.y), std::min(b.lower.z, p.z)};
    b.upper = {std::max(b.upper.x, p.x), std::max(b.upper.y, p.y), std::max(b.upper.z, p.z)};
  }
  return b;
}

/// More cubes than an input should take time for, and not so many that they are refused.
bool isLong(const SoftLatticeDef& def) {
  const auto [lower, upper] = boundsOf(def.points);
  double cubes = 1;
  for (const float size : {upper.x - lower.x, upper.y - lower.y, upper.z - lower.z})
    cubes *= std::max(1.0, double{size} / double{def.cellSize});
  return cubes > 4000 && cubes < 1e7;
}

void checkMesh(const SoftMeshData& mesh, const SoftLatticeDef& def) {
  const SoftMeshReport& report = mesh.report();
  require(report.inverted + report.degenerate + report.duplicate + report.unused == 0, "a lattice that was repaired");
  const SoftMeshQuality quality = qualityOf(mesh);
  require(quality.leastAngle >= 9 * kDegree && quality.greatestAngle <= 166 * kDegree, "a thin tetrahedron");
  require(quality.leastHeight >= 0.05 * double{def.cellSize}, "a flat tetrahedron");
  const auto [lower, upper] = boundsOf(def.points);
  const float far = 2 * def.cellSize;
  for (const Vec3 p : mesh.points())
    require(p.x >= lower.x - far && p.y >= lower.y - far && p.z >= lower.z - far && p.x <= upper.x + far &&
                p.y <= upper.y + far && p.z <= upper.z + far,
            "a point far outside the surface");
}

/// Fine points stay where they are while the cage does.
void checkBinding(std::shared_ptr<const SoftMeshData> mesh, std::span<const Vec3> points) {
  const SurfaceBinding binding({mesh, points});
  std::vector<Vec3d> cage, out(points.size());
  for (const Vec3 p : mesh->points()) cage.push_back(toDouble(p));
  binding.skin(cage, out);
  for (size_t i = 0; i < out.size(); ++i)
    require(length(out[i] - toDouble(points[i])) <= 1e-9 * (1 + length(toDouble(points[i]))), "a point that moved");
}

}  // namespace
}  // namespace avbd::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace avbd;
  fuzz::Bytes in(data, size);
  const fuzz::Surface surface = fuzz::surfaceOf(in);
  SoftLatticeDef def{.points = surface.points, .triangles = surface.triangles};
  def.cellSize = in.below(16) == 15 ? in.number() : 1 + static_cast<float>(in.byte()) / 32;
  def.fit = in.flag() ? LatticeFit::Cover : LatticeFit::Surface;
  if (fuzz::isLong(def)) return 0;
  try {
    const auto mesh = makeTetLattice(def);
    fuzz::checkMesh(*mesh, def);
    fuzz::checkBinding(mesh, surface.points);
  } catch (const Error&) {
  }
  return 0;
}
