// Solids of tetrahedra (soft_mesh.h).
#include <avbd/error.h>

#include <algorithm>
#include <cmath>

#include "base/format.h"
#include "geom/soft_mesh_parts.h"

namespace avbd {

using namespace soft_mesh;

namespace {

using Tet = std::array<uint32_t, 4>;

[[noreturn]] void refuse(std::string field, std::string value, std::string range) {
  throw Error("TetMeshDef", std::move(field), std::move(value), std::move(range));
}

double sixVolumes(std::span<const Vec3> points, const Tet& t) {
  const Vec3d o = toDouble(points[t[0]]);
  const Vec3d a = toDouble(points[t[1]]) - o, b = toDouble(points[t[2]]) - o, c = toDouble(points[t[3]]) - o;
  return dot(a, crossOf(b, c));
}

/// Faces opposite each corner, seen from outside.
constexpr uint32_t kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// Its least height is three volumes over its largest face.
bool isFlat(std::span<const Vec3> points, const Tet& t, double six) {
  double longest = 0, largest = 0;
  for (const auto& f : kFaces) {
    const Vec3d o = toDouble(points[t[f[0]]]);
    const Vec3d a = toDouble(points[t[f[1]]]) - o, b = toDouble(points[t[f[2]]]) - o, c = b - a;
    const Vec3d n = crossOf(a, b);
    largest = std::max(largest, dot(n, n));
    longest = std::max({longest, dot(a, a), dot(b, b), dot(c, c)});
  }
  return !(std::fabs(six) > kFlat * std::sqrt(largest) * std::sqrt(longest));
}

/// A face with its tetrahedron.
struct Face {
  std::array<uint32_t, 3> key, corners;
  uint32_t tet;
};

std::vector<Face> facesOf(const std::vector<Tet>& tets) {
  std::vector<Face> faces;
  faces.reserve(4 * tets.size());
  for (uint32_t i = 0; i < tets.size(); ++i)
    for (const auto& f : kFaces) {
      const std::array<uint32_t, 3> corners{tets[i][f[0]], tets[i][f[1]], tets[i][f[2]]};
      std::array<uint32_t, 3> key = corners;
      std::sort(key.begin(), key.end());
      faces.push_back({key, corners, i});
    }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.tet < b.tet; });
  return faces;
}

std::vector<std::array<uint32_t, 3>> surfaceOf(const std::vector<Tet>& tets) {
  std::vector<Face> faces = facesOf(tets), outer;
  for (size_t i = 0, end; i < faces.size(); i = end) {
    for (end = i + 1; end < faces.size() && faces[end].key == faces[i].key;) ++end;
    if (end - i > 2)
      refuse("tets",
             toText(end - i) + " of them share the face " + toText(faces[i].key[0]) + " " + toText(faces[i].key[1]) +
                 " " + toText(faces[i].key[2]),
             "must be at most two at a face");
    if (end - i == 1) outer.push_back(faces[i]);
  }
  std::sort(outer.begin(), outer.end(), [](const Face& a, const Face& b) { return a.corners < b.corners; });
  std::vector<std::array<uint32_t, 3>> surface;
  for (const Face& face : outer) surface.push_back(face.corners);
  return surface;
}

std::vector<Tet> repaired(const TetMeshDef& def, SoftMeshReport& report) {
  std::vector<Tet> kept;
  for (Tet t : def.tets) {
    const double six = sixVolumes(def.points, t);
    if (isFlat(def.points, t, six)) {
      ++report.degenerate;
      continue;
    }
    if (six < 0) std::swap(t[2], t[3]), ++report.inverted;
    kept.push_back(t);
  }
  dropDuplicates(kept, report);
  if (kept.empty()) refuse("tets", toText(def.tets.size()) + " tetrahedra", "must have at least one that has volume");
  return kept;
}

}  // namespace

std::shared_ptr<const SoftMeshData> makeTetMesh(const TetMeshDef& def) {
  check("TetMeshDef", "tets", def.points, def.tets);
  auto parts = std::make_unique<SoftMeshData::Parts>();
  parts->tets = repaired(def, parts->report);
  takePoints(def.points, parts->tets, *parts);
  parts->surface = surfaceOf(parts->tets);
  for (const Tet& t : parts->tets) parts->volume += sixVolumes(parts->points, t) / 6;
  return finish(std::move(parts));
}

std::shared_ptr<const SoftMeshData> makeTetBox(Vec3 h, int nx, int ny, int nz) {
  const auto no = [](const char* field, std::string value, const char* range) {
    throw Error("makeTetBox", field, std::move(value), range);
  };
  if (!(h.x > 0 && h.y > 0 && h.z > 0 && h.x <= 1e6f && h.y <= 1e6f && h.z <= 1e6f))
    no("h", toText(h), "must be finite and > 0 and at most 1e+06");
  for (const int n : {nx, ny, nz})
    if (n < 1 || n > 1000) no("cells", toText(n), "must be 1 .. 1000");
  std::vector<Vec3> points;
  const auto along = [](float half, int i, int n) {
    return half * (2 * static_cast<float>(i) / static_cast<float>(n) - 1);
  };
  for (int z = 0; z <= nz; ++z)
    for (int y = 0; y <= ny; ++y)
      for (int x = 0; x <= nx; ++x) points.push_back({along(h.x, x, nx), along(h.y, y, ny), along(h.z, z, nz)});
  const auto point = [&](int x, int y, int z) { return static_cast<uint32_t>((z * (ny + 1) + y) * (nx + 1) + x); };
  // Corners by their bits x, y, z. The middle tetrahedron joins every second one; a neighbour's joins the others.
  constexpr int kTets[2][5][4] = {{{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 3, 0, 6}, {4, 5, 6, 0}, {7, 6, 5, 3}},
                                  {{1, 2, 4, 7}, {0, 1, 2, 4}, {3, 1, 7, 2}, {5, 1, 4, 7}, {6, 2, 7, 4}}};
  std::vector<Tet> tets;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        for (const auto& corners : kTets[(x + y + z) & 1]) {
          Tet t{};
          for (size_t i = 0; i < 4; ++i)
            t[i] = point(x + (corners[i] & 1), y + (corners[i] >> 1 & 1), z + (corners[i] >> 2));
          tets.push_back(t);
        }
  return makeTetMesh({points, tets});
}

}  // namespace avbd
