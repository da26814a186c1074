// For the tests: surfaces made from formulas, and small shapes to put on them.
#pragma once

#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "collide/collide_surface.h"
#include "collide/pair_math.h"

namespace avbd::surface_test {

/// A MeshDef with its arrays.
struct SurfaceDef {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint16_t> materials;
  bool doubleSided = false;
};

inline Geometry meshOf(const SurfaceDef& def) {
  return Mesh{makeMesh({.vertices = def.vertices,
                        .triangles = def.triangles,
                        .materials = def.materials,
                        .doubleSided = def.doubleSided})};
}

inline float flat(float, float) { return 0; }

/// Cells of two triangles about the origin, their diagonals to and fro.
template <class F>
SurfaceDef grid(int columns, int rows, float spacing, F&& height) {
  SurfaceDef s;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c <= columns; ++c) {
      const float x = (static_cast<float>(c) - 0.5f * static_cast<float>(columns)) * spacing;
      const float z = (static_cast<float>(r) - 0.5f * static_cast<float>(rows)) * spacing;
      s.vertices.push_back({x, height(x, z), z});
    }
  }
  const auto at = [&](int c, int r) { return static_cast<uint32_t>(r * (columns + 1) + c); };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const uint32_t a = at(c, r), b = at(c, r + 1), d = at(c + 1, r + 1), e = at(c + 1, r);
      if ((c + r) % 2 == 0) {
        s.triangles.push_back({a, b, d});
        s.triangles.push_back({a, d, e});
      } else {
        s.triangles.push_back({a, b, e});
        s.triangles.push_back({b, d, e});
      }
    }
  }
  return s;
}

inline void triangle(SurfaceDef& s, Vec3 a, Vec3 b, Vec3 c) {
  const auto first = static_cast<uint32_t>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), {a, b, c});
  s.triangles.push_back({first, first + 1, first + 2});
}
/// Anticlockwise seen from the front.
inline void quad(SurfaceDef& s, Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  triangle(s, a, b, c);
  triangle(s, a, c, d);
}

/// Every triangle shrunk by nothing but rounding, so that no two share a vertex.
inline SurfaceDef torn(const SurfaceDef& from) {
  SurfaceDef s;
  for (const auto& t : from.triangles) {
    Vec3 v[3];
    for (size_t k = 0; k < 3; ++k) v[k] = from.vertices[t[k]];
    const Vec3 middle = (v[0] + v[1] + v[2]) * (1.0f / 3);
    for (Vec3& p : v) p = {p.x + (middle.x - p.x) * 2e-6f, p.y, p.z + (middle.z - p.z) * 2e-6f};
    triangle(s, v[0], v[1], v[2]);
  }
  return s;
}

/// Flat ground of cells, each second one cut in four times as many.
inline SurfaceDef withTJunctions(int cells, float size) {
  SurfaceDef s;
  const float half = 0.5f * static_cast<float>(cells) * size;
  for (int r = 0; r < cells; ++r) {
    for (int c = 0; c < cells; ++c) {
      const int parts = (c + r) % 2 == 0 ? 1 : 2;
      const float w = size / static_cast<float>(parts);
      for (int k = 0; k < parts * parts; ++k) {
        const float x = static_cast<float>(c) * size - half + w * static_cast<float>(k % parts);
        const float z = static_cast<float>(r) * size - half + w * static_cast<float>(k / parts);
        quad(s, {x, 0, z}, {x, 0, z + w}, {x + w, 0, z + w}, {x + w, 0, z});
      }
    }
  }
  return s;
}

/// Four sides, no base, tip at (0, height, 0).
inline SurfaceDef pyramid(float half, float height) {
  SurfaceDef s;
  const Vec3 tip{0, height, 0}, a{-half, 0, -half}, b{-half, 0, half}, c{half, 0, half}, d{half, 0, -half};
  triangle(s, tip, a, b);
  triangle(s, tip, b, c);
  triangle(s, tip, c, d);
  triangle(s, tip, d, a);
  return s;
}

/// The unit cube's surface, each side in parts x parts squares.
inline SurfaceDef cubeMesh(int parts) {
  SurfaceDef s;
  const float w = 1.0f / static_cast<float>(parts);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-0.5f, 0.5f}) {
      for (int k = 0; k < parts * parts; ++k) {
        const float u = w * static_cast<float>(k % parts) - 0.5f, v = w * static_cast<float>(k / parts) - 0.5f;
        const auto at = [&](float a, float b) {
          Axes p{};
          p[axis] = side;
          p[kNext[axis]] = a;
          p[kLast[axis]] = b;
          return vec(p);
        };
        if (side > 0) {
          quad(s, at(u, v), at(u + w, v), at(u + w, v + w), at(u, v + w));
        } else {
          quad(s, at(u, v), at(u, v + w), at(u + w, v + w), at(u + w, v));
        }
      }
    }
  }
  return s;
}

template <class F>
Geometry fieldOf(int columns, int rows, float spacing, F&& height, float thickness = 0,
                 std::vector<uint16_t> materials = {}) {
  std::vector<float> heights;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      heights.push_back(height((static_cast<float>(c) - 0.5f * static_cast<float>(columns - 1)) * spacing,
                               (static_cast<float>(r) - 0.5f * static_cast<float>(rows - 1)) * spacing));
    }
  }
  return HeightField{makeHeightField({.columns = columns,
                                      .rows = rows,
                                      .spacingX = spacing,
                                      .spacingZ = spacing,
                                      .heights = heights,
                                      .materials = materials,
                                      .thickness = thickness})};
}

/// An upright prism of six sides.
inline std::shared_ptr<const HullData> prism(float radius, float half) {
  std::vector<Vec3> points;
  for (int k = 0; k < 6; ++k) {
    const float a = 1.0471975512f * static_cast<float>(k);
    points.push_back({radius * std::cos(a), half, radius * std::sin(a)});
    points.push_back({radius * std::cos(a), -half, radius * std::sin(a)});
  }
  return makeHull({.points = points});
}

inline Quat turned(float angle, Vec3 axis) {
  const float s = std::sin(angle / 2) / length(axis);
  return {std::cos(angle / 2), axis.x * s, axis.y * s, axis.z * s};
}

inline std::vector<SurfacePatch> touch(const ShapeGeom& convex, const NearPose& pose, const Geometry& surface,
                                       const NearPose& surfacePose, float margin) {
  std::vector<SurfacePatch> out;
  collideSurface(convex, pose, toShapeGeom(surface), surfacePose, margin, out);
  return out;
}

inline float deepest(const Manifold& m) {
  float least = m.points[0].separation;
  for (int k = 1; k < m.count; ++k) least = std::fmin(least, m.points[k].separation);
  return least;
}

}  // namespace avbd::surface_test
