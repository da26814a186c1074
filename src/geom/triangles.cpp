// Triangles of surfaces near something (triangles.h).
#include "geom/triangles.h"

#include "geom/height_field_walk.h"
#include "geom/mesh_parts.h"

namespace avbd {
namespace {

Vec3 scaled(Vec3 v, Vec3 s) { return {v.x * s.x, v.y * s.y, v.z * s.z}; }
Vec3 unscaled(Vec3 v, Vec3 s) { return {v.x / s.x, v.y / s.y, v.z / s.z}; }
float magnitude(float x) { return x < 0 ? -x : x; }
Vec3 magnitude(Vec3 v) { return {magnitude(v.x), magnitude(v.y), magnitude(v.z)}; }
float larger(float a, float b) { return a > b ? a : b; }
float smaller(float a, float b) { return a < b ? a : b; }

/// What rounding may move points of this size by.
float rounding(Vec3 a) {
  const Vec3 m = magnitude(a);
  return 1e-6f * larger(m.x, larger(m.y, m.z));
}

Aabb ordered(Vec3 a, Vec3 b) {
  return {{smaller(a.x, b.x), smaller(a.y, b.y), smaller(a.z, b.z)},
          {larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z)}};
}

/// The box in the data's own frame, grown by what rounding can lose.
Aabb unscaledBox(const Aabb& box, Vec3 scale) {
  const Vec3 a = unscaled(box.lower, scale), b = unscaled(box.upper, scale);
  const Aabb to = ordered(a, b);
  const Vec3 e{1e-6f * larger(magnitude(a.x), magnitude(b.x)), 1e-6f * larger(magnitude(a.y), magnitude(b.y)),
               1e-6f * larger(magnitude(a.z), magnitude(b.z))};
  return {to.lower - e, to.upper + e};
}

SweptBox unscaledWay(Vec3 from, Vec3 motion, Vec3 halfExtent, const ShapeGeom& surface, const Aabb& data) {
  const Vec3 s = surface.scale, start = unscaled(from, s), way = unscaled(motion, s);
  const float pad =
      larger(larger(rounding(start), rounding(start + way)), larger(rounding(data.lower), rounding(data.upper)));
  return {start, way, magnitude(unscaled(halfExtent, s)) + Vec3{pad, pad, pad}};
}

/// Whether a triangle's bounds overlap a box.
bool overlaps(const Vec3* v, const Aabb& box) {
  const Vec3 low{smaller(v[0].x, smaller(v[1].x, v[2].x)), smaller(v[0].y, smaller(v[1].y, v[2].y)),
                 smaller(v[0].z, smaller(v[1].z, v[2].z))};
  const Vec3 high{larger(v[0].x, larger(v[1].x, v[2].x)), larger(v[0].y, larger(v[1].y, v[2].y)),
                  larger(v[0].z, larger(v[1].z, v[2].z))};
  return overlaps(Aabb{low, high}, box);
}

void noNeighbours(SurfaceTriangle& t) {
  for (int i = 0; i < 3; ++i) {
    t.across[i] = t.normal;
    t.isRim[i] = true;
    t.isConvex[i] = false;
  }
}

void setAcross(SurfaceTriangle& t, int edge, Vec3 across) {
  t.across[edge] = across;
  t.isRim[edge] = false;
  t.isConvex[edge] = bendOf(t.normal, across, t.v[(edge + 1) % 3] - t.v[edge]) == Bend::Ridge;
}

/// Triangles of a mesh under a scale.
struct MeshView {
  const MeshData::Parts& parts;
  Vec3 scale;
  bool mirrored, even;

  explicit MeshView(const ShapeGeom& surface)
      : parts(surface.mesh().parts()),
        scale(surface.scale),
        mirrored(((scale.x < 0) != (scale.y < 0)) != (scale.z < 0)),
        even(magnitude(scale.x) == magnitude(scale.y) && magnitude(scale.y) == magnitude(scale.z)) {}

  /// Mirrored, corners 1 and 2 change places, so that the front stays in front.
  void corners(uint32_t element, Vec3* v) const {
    const uint32_t* index = parts.triangles[element].vertex;
    v[0] = scaled(parts.vertices[index[0]], scale);
    v[mirrored ? 2 : 1] = scaled(parts.vertices[index[1]], scale);
    v[mirrored ? 1 : 2] = scaled(parts.vertices[index[2]], scale);
  }
  void fill(uint32_t element, SurfaceTriangle& t) const {
    t.normal = triangleNormal(t.v[0], t.v[1], t.v[2]);
    t.element = element;
    t.material = parts.materials.empty() ? uint16_t{0} : parts.materials[element];
    t.doubleSided = parts.doubleSided;
    noNeighbours(t);
  }
  void fillAcross(uint32_t element, SurfaceTriangle& t) const {
    const MeshTriangle& triangle = parts.triangles[element];
    for (int i = 0; i < 3; ++i) {
      const uint32_t link = triangle.link[i];
      if (link == MeshTriangle::kNone) continue;
      const int edge = mirrored ? 2 - i : i;
      if ((link & MeshTriangle::kFlat) && even) {
        t.isRim[edge] = false;
        continue;
      }
      Vec3 v[3];
      corners(link & ~MeshTriangle::kFlat, v);
      setAcross(t, edge, triangleNormal(v[0], v[1], v[2]));
    }
  }
};

/// Triangles of a height field under a scale.
struct FieldView {
  const HeightFieldData::Parts& parts;
  Vec3 scale;

  explicit FieldView(const ShapeGeom& surface) : parts(surface.heights().parts()), scale(surface.scale) {}

  Vec3 corner(int c, int r) const { return scaled(parts.corner(c, r), scale); }
  void corners(int c, int r, int half, Vec3* v) const {
    v[0] = corner(c, r);
    v[1] = half == 0 ? corner(c, r + 1) : corner(c + 1, r + 1);
    v[2] = half == 0 ? corner(c + 1, r + 1) : corner(c + 1, r);
  }
  void fill(int c, int r, int half, SurfaceTriangle& t) const {
    t.normal = triangleNormal(t.v[0], t.v[1], t.v[2]);
    t.element = 2 * (static_cast<uint32_t>(r) * static_cast<uint32_t>(parts.cellColumns()) + static_cast<uint32_t>(c)) +
                static_cast<uint32_t>(half);
    t.material = parts.material(c, r);
    t.doubleSided = false;
    noNeighbours(t);
  }
  void fillAcross(int c, int r, int half, SurfaceTriangle& t) const {
    // Across edges 0, 1, 2: the cell's other half, or the opposite half of a cell beside.
    constexpr int kColumn[2][3] = {{-1, 0, 0}, {0, 1, 0}}, kRow[2][3] = {{0, 1, 0}, {0, 0, -1}};
    for (int i = 0; i < 3; ++i) {
      const int nc = c + kColumn[half][i], nr = r + kRow[half][i];
      if (!parts.isClosed(nc, nr)) continue;
      Vec3 v[3];
      corners(nc, nr, 1 - half, v);
      setAcross(t, i, triangleNormal(v[0], v[1], v[2]));
    }
  }
};

}  // namespace

void forEachBareTriangle(const ShapeGeom& surface, const Aabb& box, FunctionRef<bool(const SurfaceTriangle&)> f) {
  const Aabb own = unscaledBox(box, surface.scale);
  SurfaceTriangle t;
  if (surface.type == ShapeType::Mesh) {
    const MeshView view(surface);
    walkBox(view.parts.tree, own, [&](uint32_t first, uint32_t count) {
      for (uint32_t i = first; i < first + count; ++i) {
        view.corners(i, t.v);
        if (!overlaps(t.v, box)) continue;
        view.fill(i, t);
        if (!f(t)) return false;
      }
      return true;
    });
    return;
  }
  const FieldView view(surface);
  const auto cell = [&](int c, int r) {
    for (int half = 0; half < 2; ++half) {
      view.corners(c, r, half, t.v);
      if (!overlaps(t.v, box)) continue;
      view.fill(c, r, half, t);
      if (!f(t)) return false;
    }
    return true;
  };
  CellsInBox(view.parts, own, cell);
}

void findNeighbours(const ShapeGeom& surface, SurfaceTriangle& triangle) {
  if (surface.type == ShapeType::Mesh) return MeshView(surface).fillAcross(triangle.element, triangle);
  const FieldView view(surface);
  const int cell = static_cast<int>(triangle.element / 2), columns = view.parts.cellColumns();
  view.fillAcross(cell % columns, cell / columns, static_cast<int>(triangle.element % 2), triangle);
}

void forEachTriangle(const ShapeGeom& surface, const Aabb& box, FunctionRef<bool(const SurfaceTriangle&)> f) {
  forEachBareTriangle(surface, box, [&](const SurfaceTriangle& bare) {
    SurfaceTriangle t = bare;
    findNeighbours(surface, t);
    return f(t);
  });
}

void forEachTriangleAlong(const ShapeGeom& surface, Vec3 from, Vec3 motion, Vec3 halfExtent,
                          FunctionRef<float(const SurfaceTriangle&, float)> f) {
  SurfaceTriangle t;
  if (surface.type == ShapeType::Mesh) {
    const MeshView view(surface);
    const SweptBox swept = unscaledWay(from, motion, halfExtent, surface, {view.parts.lower, view.parts.upper});
    walkAlong(view.parts.tree, swept, [&](uint32_t first, uint32_t count, float fraction) {
      for (uint32_t i = first; i < first + count && fraction >= 0; ++i) {
        view.corners(i, t.v);
        view.fill(i, t);
        fraction = f(t, fraction);
      }
      return fraction;
    });
    return;
  }
  const FieldView view(surface);
  const SweptBox swept = unscaledWay(from, motion, halfExtent, surface, {view.parts.lower, view.parts.upper});
  const auto cell = [&](int c, int r, float fraction) {
    for (int half = 0; half < 2 && fraction >= 0; ++half) {
      view.corners(c, r, half, t.v);
      view.fill(c, r, half, t);
      fraction = f(t, fraction);
    }
    return fraction;
  };
  CellsAlong(view.parts, swept, cell);
}

Aabb surfaceBounds(const ShapeGeom& surface) {
  if (surface.type == ShapeType::Mesh) {
    const MeshData::Parts& parts = surface.mesh().parts();
    return ordered(scaled(parts.lower, surface.scale), scaled(parts.upper, surface.scale));
  }
  const HeightFieldData::Parts& parts = surface.heights().parts();
  const Vec3 below{0, parts.thickness, 0};
  return ordered(scaled(parts.lower - below, surface.scale), scaled(parts.upper, surface.scale));
}

}  // namespace avbd
