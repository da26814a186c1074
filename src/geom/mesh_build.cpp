// From a list of triangles to a clean one: welds, drops, finds neighbours, orders by the tree (mesh_parts.h).
#include <algorithm>
#include <cmath>

#include "geom/mesh_parts.h"

namespace avbd {
namespace {

/// A triangle whose height is less than this part of its longest edge has no usable normal.
constexpr double kNoArea = 1e-6;

Vec3d crossOf(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

uint64_t mixed(uint64_t x) {
  x = (x ^ (x >> 31)) * 0x9e3779b97f4a7c15u;
  return x ^ (x >> 29);
}

/// Finds vertices near a point: those kept so far, in lists by cell.
class WeldGrid {
 public:
  WeldGrid(std::span<const Vec3> vertices, double distance) : distance_(distance) {
    double farthest = 0;
    for (const Vec3 v : vertices)
      farthest = std::max({farthest, std::fabs(double{v.x}), std::fabs(double{v.y}), std::fabs(double{v.z})});
    // Cells as wide as the distance, or wider where a double could not count them. To find equal vertices any do.
    cell_ = std::max(distance > 0 ? distance : kAnyCell, farthest * kFinestCell);
    size_t size = 16;
    while (size < vertices.size() * 2) size *= 2;
    heads_.assign(size, kEnd);
  }

  /// The first kept vertex within the distance; or keeps this one.
  uint32_t add(Vec3 v, std::vector<Vec3>& kept) {
    const int64_t cell[3] = {cellOf(v.x), cellOf(v.y), cellOf(v.z)};
    const int around = distance_ > 0 ? 1 : 0;
    uint32_t found = kEnd;
    for (int64_t x = cell[0] - around; x <= cell[0] + around; ++x) {
      for (int64_t y = cell[1] - around; y <= cell[1] + around; ++y) {
        for (int64_t z = cell[2] - around; z <= cell[2] + around; ++z) found = std::min(found, find(x, y, z, v, kept));
      }
    }
    if (found != kEnd) return found;
    const auto index = static_cast<uint32_t>(kept.size());
    kept.push_back({v.x + 0.0f, v.y + 0.0f, v.z + 0.0f});  // no -0: equal meshes have equal bits
    uint32_t& head = heads_[slot(cell[0], cell[1], cell[2])];
    next_.push_back(head);
    head = index;
    return index;
  }

 private:
  static constexpr uint32_t kEnd = 0xffffffffu;
  static constexpr double kAnyCell = 1.0 / 1048576;                 // [m]
  static constexpr double kFinestCell = 1.0 / (uint64_t{1} << 50);  // parts of the farthest coordinate

  int64_t cellOf(float x) const { return static_cast<int64_t>(std::floor(x / cell_)); }
  size_t slot(int64_t x, int64_t y, int64_t z) const {
    const uint64_t h =
        mixed(mixed(mixed(static_cast<uint64_t>(x)) + static_cast<uint64_t>(y)) + static_cast<uint64_t>(z));
    return static_cast<size_t>(h) & (heads_.size() - 1);
  }
  uint32_t find(int64_t x, int64_t y, int64_t z, Vec3 v, const std::vector<Vec3>& kept) const {
    uint32_t found = kEnd;
    for (uint32_t k = heads_[slot(x, y, z)]; k != kEnd; k = next_[k]) {
      const Vec3d d = toDouble(kept[k]) - toDouble(v);
      if (dot(d, d) <= distance_ * distance_) found = std::min(found, k);
    }
    return found;
  }

  double distance_, cell_;
  std::vector<uint32_t> heads_, next_;
};

bool hasArea(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3d u = toDouble(b) - toDouble(a), v = toDouble(c) - toDouble(a), w = toDouble(c) - toDouble(b);
  const Vec3d n = crossOf(u, v);
  const double longest = std::max({dot(u, u), dot(v, v), dot(w, w)});
  return longest > 0 && dot(n, n) > kNoArea * kNoArea * longest * longest;
}

/// Entries sorted by a vertex index, then by the rest: counting first keeps it linear.
struct Keyed {
  uint32_t second, third, index;
  bool operator<(const Keyed& o) const {
    return second != o.second ? second < o.second : (third != o.third ? third < o.third : index < o.index);
  }
};

class Buckets {
 public:
  Buckets(size_t vertices, size_t entries) : start_(vertices + 1, 0), entries_(entries) {}
  void count(uint32_t first) { ++start_[first + 1]; }
  void counted() {
    for (size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    fill_.assign(start_.begin(), start_.end() - 1);
  }
  void put(uint32_t first, const Keyed& entry) { entries_[fill_[first]++] = entry; }
  template <class F>
  void forEach(F&& f) {
    for (size_t v = 0; v + 1 < start_.size(); ++v) {
      const std::span<Keyed> all(entries_.data() + start_[v], start_[v + 1] - start_[v]);
      std::sort(all.begin(), all.end());
      f(all);
    }
  }

 private:
  std::vector<uint32_t> start_, fill_;
  std::vector<Keyed> entries_;
};

/// Corners with the least first: two triangles of the same corners agree. Without winding: sorted.
void canonical(const uint32_t* vertex, bool winding, uint32_t* to) {
  std::copy(vertex, vertex + 3, to);
  if (!winding) return std::sort(to, to + 3);
  std::rotate(to, std::min_element(to, to + 3), to + 3);
}

std::vector<bool> findDuplicates(const MeshData::Parts& parts) {
  Buckets buckets(parts.vertices.size(), parts.triangles.size());
  uint32_t key[3];
  for (const MeshTriangle& t : parts.triangles) buckets.count(std::min({t.vertex[0], t.vertex[1], t.vertex[2]}));
  buckets.counted();
  for (uint32_t i = 0; i < parts.triangles.size(); ++i) {
    canonical(parts.triangles[i].vertex, !parts.doubleSided, key);
    buckets.put(key[0], {key[1], key[2], i});
  }
  std::vector<bool> again(parts.triangles.size(), false);
  buckets.forEach([&](std::span<const Keyed> all) {
    for (size_t k = 1; k < all.size(); ++k) {
      if (all[k].second == all[k - 1].second && all[k].third == all[k - 1].third) again[all[k].index] = true;
    }
  });
  return again;
}

Vec3 normalOf(const MeshData::Parts& parts, uint32_t triangle) {
  const uint32_t* v = parts.triangles[triangle].vertex;
  return triangleNormal(parts.vertices[v[0]], parts.vertices[v[1]], parts.vertices[v[2]]);
}

/// Half edges 3 triangle + edge that meet in one edge.
void linkEdge(MeshData::Parts& parts, uint32_t a, uint32_t b) {
  MeshTriangle &ta = parts.triangles[a / 3], &tb = parts.triangles[b / 3];
  const uint32_t from = ta.vertex[a % 3], to = ta.vertex[(a % 3 + 1) % 3];
  const Vec3 along = parts.vertices[to] - parts.vertices[from];
  const bool flat = bendOf(normalOf(parts, a / 3), normalOf(parts, b / 3), along) == Bend::Flat;
  ta.link[a % 3] = b / 3 | (flat ? MeshTriangle::kFlat : 0);
  tb.link[b % 3] = a / 3 | (flat ? MeshTriangle::kFlat : 0);
}

}  // namespace

void weldVertices(const MeshDef& def, MeshData::Parts& parts) {
  WeldGrid grid(def.vertices, def.weldDistance);
  std::vector<uint32_t> to(def.vertices.size());
  for (size_t i = 0; i < to.size(); ++i) to[i] = grid.add(def.vertices[i], parts.vertices);
  parts.triangles.resize(def.triangles.size());
  for (size_t i = 0; i < def.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) parts.triangles[i].vertex[k] = to[def.triangles[i][k]];
  }
}

void dropBadTriangles(const MeshDef& def, MeshData::Parts& parts) {
  const std::vector<bool> again = findDuplicates(parts);
  size_t kept = 0;
  for (uint32_t i = 0; i < def.triangles.size(); ++i) {
    const MeshTriangle t = parts.triangles[i];
    if (!hasArea(parts.vertices[t.vertex[0]], parts.vertices[t.vertex[1]], parts.vertices[t.vertex[2]])) {
      ++parts.report.degenerate;
      continue;
    }
    if (again[i]) {
      ++parts.report.duplicate;
      continue;
    }
    parts.triangles[kept++] = t;
    parts.source.push_back(i);
    if (!def.materials.empty()) parts.materials.push_back(def.materials[i]);
  }
  parts.triangles.resize(kept);
  parts.report.triangles = static_cast<uint32_t>(kept);
}

void linkTriangles(MeshData::Parts& parts) {
  Buckets buckets(parts.vertices.size(), parts.triangles.size() * 3);
  for (const MeshTriangle& t : parts.triangles) {
    for (int k = 0; k < 3; ++k) buckets.count(std::min(t.vertex[k], t.vertex[(k + 1) % 3]));
  }
  buckets.counted();
  for (uint32_t i = 0; i < parts.triangles.size(); ++i) {
    MeshTriangle& t = parts.triangles[i];
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t a = t.vertex[k], b = t.vertex[(k + 1) % 3];
      buckets.put(std::min(a, b), {std::max(a, b), a < b ? 0u : 1u, 3 * i + k});
      t.link[k] = MeshTriangle::kNone;
    }
  }
  buckets.forEach([&](std::span<const Keyed> all) {
    for (size_t k = 0, end = 0; k < all.size(); k = end) {
      while (end < all.size() && all[end].second == all[k].second) ++end;
      if (end - k == 1) {
        ++parts.report.boundaryEdges;
      } else if (end - k == 2 && all[k].third != all[k + 1].third) {
        linkEdge(parts, all[k].index, all[k + 1].index);
      } else {
        ++parts.report.nonManifoldEdges;
      }
    }
  });
}

void orderByTree(MeshData::Parts& parts) {
  const size_t count = parts.triangles.size();
  std::vector<Aabb> boxes(count);
  for (size_t i = 0; i < count; ++i) {
    const uint32_t* v = parts.triangles[i].vertex;
    const Vec3 a = parts.vertices[v[0]], b = parts.vertices[v[1]], c = parts.vertices[v[2]];
    boxes[i] = {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
                {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}};
  }
  std::vector<uint32_t> order, place(count);
  parts.tree = buildMeshTree(boxes, order);
  for (uint32_t i = 0; i < count; ++i) place[order[i]] = i;

  constexpr uint32_t kUnused = 0xffffffffu;
  std::vector<uint32_t> vertexTo(parts.vertices.size(), kUnused);
  std::vector<Vec3> vertices;
  std::vector<MeshTriangle> triangles(count);
  std::vector<uint32_t> source(count);
  std::vector<uint16_t> materials(parts.materials.size());
  for (size_t i = 0; i < count; ++i) {
    const MeshTriangle& from = parts.triangles[order[i]];
    for (int k = 0; k < 3; ++k) {
      uint32_t& to = vertexTo[from.vertex[k]];
      if (to == kUnused) {
        to = static_cast<uint32_t>(vertices.size());
        vertices.push_back(parts.vertices[from.vertex[k]]);
      }
      triangles[i].vertex[k] = to;
      const uint32_t link = from.link[k];
      triangles[i].link[k] =
          link == MeshTriangle::kNone ? link : place[link & ~MeshTriangle::kFlat] | (link & MeshTriangle::kFlat);
    }
    source[i] = parts.source[order[i]];
    if (!materials.empty()) materials[i] = parts.materials[order[i]];
  }
  vertices.shrink_to_fit();
  parts.vertices.swap(vertices);
  parts.triangles.swap(triangles);
  parts.source.swap(source);
  parts.materials.swap(materials);
}

}  // namespace avbd
