// The flat part of a core that looks most along a direction (convex.h).
//
// Names: the face or edge in the bits above 8, the point in the lowest 8. A cap of a cylinder or cone is given by eight
// points that stay where they are on it, so that a can at rest keeps its points, and, once it is tilted, by the point
// of its rim that is farthest along the direction.
#include <avbd/hull.h>

#include "collide/support.h"

namespace avbd {
namespace {

constexpr float kHalf = 0.70710678f;     // sine and cosine of 45 degrees
constexpr float kTilted = 1.0f / 1024;   // sine of the tilt from which a cap has a deepest point
constexpr float kSamePoint = 1.0f / 64;  // part of the radius within which that replaces a fixed one

void addPoint(SupportFace& out, Vec3 p, uint32_t feature) {
  out.point[out.count] = p;
  out.feature[out.count++] = feature;
}

void ofBox(const Vec3& extent, Vec3 d, SupportFace& out) {
  const Axes a = axes(d), h = axes(extent);
  int axis = magnitude(a[1]) > magnitude(a[0]) ? 1 : 0;
  if (magnitude(a[2]) > magnitude(a[axis])) axis = 2;
  const bool positive = a[axis] > 0;
  const int u = kNext[axis], v = kLast[axis];
  Axes n{};
  n[axis] = positive ? 1.0f : -1.0f;
  out.normal = vec(n);
  for (int k = 0; k < 4; ++k) {
    const int turn = positive ? k : 3 - k;
    Axes p;
    p[axis] = positive ? h[axis] : -h[axis];
    p[u] = turn == 0 || turn == 3 ? -h[u] : h[u];
    p[v] = turn < 2 ? -h[v] : h[v];
    const uint32_t corner = (p[0] > 0 ? 1u : 0u) | (p[1] > 0 ? 2u : 0u) | (p[2] > 0 ? 4u : 0u);
    addPoint(out, vec(p), static_cast<uint32_t>(2 * axis + positive) << 8 | corner);
  }
}

/// A cap at height y with the normal (0, up, 0); d looks at it, s is the length of d across the axis.
void ofCap(float radius, float y, float up, Vec3 d, float s, SupportFace& out) {
  constexpr float kCos[8] = {1, kHalf, 0, -kHalf, -1, -kHalf, 0, kHalf};
  constexpr float kSin[8] = {0, kHalf, 1, kHalf, 0, -kHalf, -1, -kHalf};
  out.normal = {0, up, 0};
  const uint32_t name = (up > 0 ? 1u : 2u) << 8;
  const bool tilted = s > kTilted;
  const float tx = tilted ? d.x / s : 0, tz = tilted ? d.z / s : 0;
  for (int i = 0; i < 8; ++i) {
    // Seen from above (y towards the eye) x -> z turns right.
    const int k = up > 0 ? 7 - i : i;
    const float x = kCos[k], z = kSin[k];
    const int after = (k + 8 + (up > 0 ? -1 : 1)) & 7;
    const float along = x * tx + z * tz, next = kCos[after] * tx + kSin[after] * tz;
    const float ex = x - tx, ez = z - tz;
    const bool same = tilted && ex * ex + ez * ez < kSamePoint * kSamePoint;
    if (same) {
      addPoint(out, {radius * tx, y, radius * tz}, name | static_cast<uint32_t>(k));
      continue;
    }
    addPoint(out, {radius * x, y, radius * z}, name | static_cast<uint32_t>(k));
    const float fx = kCos[after] - tx, fz = kSin[after] - tz;
    const bool sameNext = fx * fx + fz * fz < kSamePoint * kSamePoint;
    // The tilt looks between this point and the next.
    if (tilted && !sameNext && along > kHalf && next > kHalf) addPoint(out, {radius * tx, y, radius * tz}, name | 8u);
  }
}

void ofCylinder(const ShapeGeom& g, Vec3 d, SupportFace& out) {
  const float s = std::sqrt(d.x * d.x + d.z * d.z), r = g.extent.x, h = g.extent.y;
  if (magnitude(d.y) >= s) return ofCap(r, d.y > 0 ? h : -h, d.y > 0 ? 1.0f : -1.0f, d, s, out);
  const float x = r * (d.x / s), z = r * (d.z / s);
  addPoint(out, {x, -h, z}, 3u << 8);
  addPoint(out, {x, h, z}, 3u << 8 | 1u);
}

void ofCone(const ShapeGeom& g, Vec3 d, SupportFace& out) {
  const float s = std::sqrt(d.x * d.x + d.z * d.z), r = g.extent.x, h = g.extent.y;
  const float slope = std::sqrt(4 * h * h + r * r), mantle = (2 * h * s + r * d.y) / slope;
  if (-d.y >= mantle) return ofCap(r, -h, -1, d, s, out);
  const bool tip = 2 * d.y * h >= r * s, point = mantle < kHalf;
  if (!(s > 0) || (point && tip)) return addPoint(out, {0, h, 0}, 3u << 8 | 1u);
  addPoint(out, {r * (d.x / s), -h, r * (d.z / s)}, 3u << 8);
  if (!point) addPoint(out, {0, h, 0}, 3u << 8 | 1u);
}

bool holds(const HullData& hull, const HullData::Face& face, uint8_t vertex) {
  for (int i = 0; i < face.count; ++i) {
    if (hull.loops()[static_cast<size_t>(face.first + i)] == vertex) return true;
  }
  return false;
}

/// Of the faces about the farthest vertex the one that looks most along d: of a spike another face may look more that
/// way, but lies far below.
void ofHull(const HullData& hull, Vec3 d, SupportFace& out) {
  const auto faces = hull.faces();
  const auto vertices = hull.vertices();
  size_t vertex = 0, best = 0;
  float far = dot(vertices[0], d), top = -2;
  for (size_t i = 1; i < vertices.size(); ++i) {
    const float x = dot(vertices[i], d);
    vertex = x > far ? i : vertex;
    far = x > far ? x : far;
  }
  for (size_t i = 0; i < faces.size(); ++i) {
    const float x = dot(faces[i].normal, d);
    if (!(x > top) || !holds(hull, faces[i], static_cast<uint8_t>(vertex))) continue;
    best = i;
    top = x;
  }
  const HullData::Face& face = faces[best];
  out.normal = face.normal;
  const uint32_t name = static_cast<uint32_t>(best) << 8;
  // Of more corners than fit, evenly many are left out.
  const int all = face.count, kept = all < SupportFace::kMax ? all : SupportFace::kMax;
  for (int i = 0; i < kept; ++i) {
    const uint8_t v = hull.loops()[static_cast<size_t>(face.first + i * all / kept)];
    addPoint(out, hull.vertices()[v], name | v);
  }
}

void ofTriangle(const Vec3* v, Vec3 d, SupportFace& out) {
  const Vec3 n = cross(v[1] - v[0], v[2] - v[0]);
  const float l = length(n);
  const bool front = dot(n, d) >= 0;
  if (l > 0) out.normal = n * ((front ? 1.0f : -1.0f) / l);
  for (uint32_t k = 0; k < 3; ++k) {
    const uint32_t i = front ? k : 2 - k;
    addPoint(out, v[i], (front ? 0u : 1u) << 8 | i);
  }
}

}  // namespace

void supportFace(const ShapeGeom& g, Vec3 d, SupportFace& out) {
  out.count = 0;
  out.normal = d;
  switch (g.type) {
    case ShapeType::Capsule:
      if (magnitude(d.y) > kHalf || !(g.extent.y > 0))
        return addPoint(out, {0, d.y < 0 ? -g.extent.y : g.extent.y, 0}, d.y < 0 ? 0 : 1);
      addPoint(out, {0, -g.extent.y, 0}, 0);
      return addPoint(out, {0, g.extent.y, 0}, 1);
    case ShapeType::Box:
    case ShapeType::RoundedBox:
      return ofBox(g.extent, d, out);
    case ShapeType::Cylinder:
      return ofCylinder(g, d, out);
    case ShapeType::Cone:
      return ofCone(g, d, out);
    case ShapeType::Hull:
      return ofHull(g.hull(), d, out);
    case ShapeType::Triangle:
      return ofTriangle(g.triangle(), d, out);
    default:
      return addPoint(out, support(g, d), 0);
  }
}

}  // namespace avbd
