// Circles, lathes and polytopes.
#include "api/debug_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace avbd {
namespace {

constexpr float kHalfTurn = 3.14159265f;

struct Profile {
  float radius, y;
};

Vec3 scaled(Vec3 v, Vec3 s) { return {v.x * s.x, v.y * s.y, v.z * s.z}; }

/// Centre + cos a + sin b, once around or from one angle to another.
void arc(const DebugPen& pen, Vec3 center, Vec3 a, Vec3 b, float from, float to) {
  const int steps = std::max(1, static_cast<int>(std::lround(pen.options.segments * (to - from) / (2 * kHalfTurn))));
  Vec3 before = center + std::cos(from) * a + std::sin(from) * b;
  for (int i = 1; i <= steps; ++i) {
    const float angle = from + (to - from) * static_cast<float>(i) / static_cast<float>(steps);
    const Vec3 next = center + std::cos(angle) * a + std::sin(angle) * b;
    pen.line(before, next);
    before = next;
  }
}

void circle(const DebugPen& pen, Vec3 center, Vec3 a, Vec3 b) { arc(pen, center, a, b, 0, 2 * kHalfTurn); }
void ring(const DebugPen& pen, float radius, float y) { circle(pen, {0, y, 0}, {radius, 0, 0}, {0, 0, radius}); }

/// Four lines along a profile that is turned about y.
void sides(const DebugPen& pen, Profile low, Profile high) {
  for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{-1, 0, 0}, Vec3{0, 0, -1}})
    pen.line(low.radius * d + Vec3{0, low.y, 0}, high.radius * d + Vec3{0, high.y, 0});
}

/// Profile from the lower end to the upper one, turned about y. Ends on the axis close.
void lathe(const DebugPen& pen, const std::vector<Profile>& profile, Vec3 scale = {1, 1, 1}) {
  const int steps = pen.options.segments;
  const auto at = [&](Profile p, int i) {
    const float angle = 2 * kHalfTurn * static_cast<float>(i % steps) / static_cast<float>(steps);
    return scaled({p.radius * std::cos(angle), p.y, p.radius * std::sin(angle)}, scale);
  };
  for (size_t k = 0; k + 1 < profile.size(); ++k) {
    const Profile low = profile[k], high = profile[k + 1];
    for (int i = 0; i < steps; ++i) {
      if (low.radius > 0) pen.triangle(at(low, i), at(high, i), at(low, i + 1));
      if (high.radius > 0) pen.triangle(at(low, i + 1), at(high, i), at(high, i + 1));
    }
  }
}

/// Points of a profile's round corner about (radius, y).
void addCorner(std::vector<Profile>& out, Profile center, float rounding, float from, float to, int segments) {
  const int steps = rounding > 0 ? std::max(2, segments / 4) : 0;
  for (int i = 0; i <= steps; ++i) {
    const float angle = from + (to - from) * (steps > 0 ? static_cast<float>(i) / static_cast<float>(steps) : 0);
    const float radius = center.radius + rounding * std::cos(angle);
    // The ends of a half-circle lie on the axis exactly.
    out.push_back({radius > 1e-6f * rounding ? radius : 0, center.y + rounding * std::sin(angle)});
  }
}

std::vector<Profile> ball(float radius, float halfHeight, int segments) {
  std::vector<Profile> out;
  addCorner(out, {0, -halfHeight}, radius, -kHalfTurn / 2, 0, segments);
  if (!(halfHeight > 0)) out.pop_back();
  addCorner(out, {0, halfHeight}, radius, 0, kHalfTurn / 2, segments);
  return out;
}

std::vector<Profile> cylinder(const Cylinder& s, int segments) {
  std::vector<Profile> out{{0, -s.halfHeight - s.rounding}};
  addCorner(out, {s.radius, -s.halfHeight}, s.rounding, -kHalfTurn / 2, 0, segments);
  addCorner(out, {s.radius, s.halfHeight}, s.rounding, 0, kHalfTurn / 2, segments);
  out.push_back({0, s.halfHeight + s.rounding});
  return out;
}

/// Angle above the horizontal in which a cone's side looks.
float slopeOf(const Cone& s) { return std::atan2(s.radius, 2 * s.halfHeight); }

std::vector<Profile> cone(const Cone& s, int segments) {
  std::vector<Profile> out{{0, -s.halfHeight - s.rounding}};
  addCorner(out, {s.radius, -s.halfHeight}, s.rounding, -kHalfTurn / 2, slopeOf(s), segments);
  addCorner(out, {0, s.halfHeight}, s.rounding, slopeOf(s), kHalfTurn / 2, segments);
  return out;
}

/// Faces of a polytope as loops of points with their normals.
struct Face {
  Vec3 normal;
  std::vector<Vec3> loop;
};

std::vector<Face> facesOf(const Box& s) {
  std::vector<Face> faces;
  const std::array<float, 3> half{s.x, s.y, s.z};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      Face face;
      std::array<float, 3> p{}, n{};
      n[axis] = side;
      p[axis] = side * half[axis];
      for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        p[u] = static_cast<float>(a) * half[u];
        p[v] = static_cast<float>(b) * half[v];
        face.loop.push_back({p[0], p[1], p[2]});
      }
      if (side < 0) std::reverse(face.loop.begin(), face.loop.end());
      face.normal = {n[0], n[1], n[2]};
      faces.push_back(face);
    }
  }
  return faces;
}

std::vector<Face> facesOf(const Hull& s) {
  std::vector<Face> faces;
  const bool mirrored = s.scale.x * s.scale.y * s.scale.z < 0;
  const Vec3 inverse{1 / s.scale.x, 1 / s.scale.y, 1 / s.scale.z};
  for (const HullData::Face& from : s.data->faces()) {
    Face face;
    const Vec3 n = scaled(from.normal, inverse);  // normals scale inversely
    face.normal = n * (1 / length(n));
    for (const uint8_t i : s.data->loops().subspan(from.first, from.count))
      face.loop.push_back(scaled(s.data->vertices()[i], s.scale));
    if (mirrored) std::reverse(face.loop.begin(), face.loop.end());
    faces.push_back(face);
  }
  return faces;
}

/// Each face moved outwards; with rounding each edge is drawn on both of its faces.
void facesWire(const DebugPen& pen, const std::vector<Face>& faces, float rounding) {
  for (const Face& face : faces) {
    for (size_t i = 0; i < face.loop.size(); ++i) {
      const Vec3 a = face.loop[i], b = face.loop[(i + 1) % face.loop.size()];
      // Without rounding both faces have the same edge: one of them draws it.
      const bool first = a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
      if (rounding > 0 || first) pen.line(a + rounding * face.normal, b + rounding * face.normal);
    }
  }
}

bool isEdge(const Face& face, Vec3 from, Vec3 to) {
  for (size_t i = 0; i < face.loop.size(); ++i)
    if (face.loop[i] == from && face.loop[(i + 1) % face.loop.size()] == to) return true;
  return false;
}

/// Faces moved outwards, a flat strip along each edge, and a ball at each corner where there is rounding.
void facesSolid(const DebugPen& pen, const std::vector<Face>& faces, float rounding) {
  std::vector<Vec3> corners;
  for (const Face& face : faces) {
    const Vec3 out = rounding * face.normal;
    for (size_t i = 2; i < face.loop.size(); ++i)
      pen.triangle(face.loop[0] + out, face.loop[i - 1] + out, face.loop[i] + out);
    if (!(rounding > 0)) continue;
    for (size_t i = 0; i < face.loop.size(); ++i) {
      const Vec3 a = face.loop[i], b = face.loop[(i + 1) % face.loop.size()];
      if (std::find(corners.begin(), corners.end(), a) == corners.end()) corners.push_back(a);
      for (const Face* other = &face + 1; other < faces.data() + faces.size(); ++other) {
        if (!isEdge(*other, b, a)) continue;
        const Vec3 away = rounding * other->normal;
        pen.triangle(a + out, a + away, b + out);
        pen.triangle(b + out, a + away, b + away);
      }
    }
  }
  for (const Vec3 corner : corners) {
    DebugPen at = pen;
    at.frame.position = pen.frame * corner;
    lathe(at, ball(rounding, 0, pen.options.segments));
  }
}

template <class Surface, class Draw>
void eachTriangle(const Surface& s, Draw draw) {
  const bool mirrored = s.scale.x * s.scale.y * s.scale.z < 0;
  for (uint32_t i = 0; i < s.data->triangleCount(); ++i) {
    auto [a, b, c] = s.data->triangle(i);
    if (mirrored) std::swap(b, c);
    draw(scaled(a, s.scale), scaled(b, s.scale), scaled(c, s.scale));
  }
}

struct Wire {
  const DebugPen& pen;

  void operator()(const Sphere& s) const { (*this)(Ellipsoid{s.radius, s.radius, s.radius}); }
  void operator()(const Ellipsoid& s) const {
    circle(pen, {}, {s.x, 0, 0}, {0, s.y, 0});
    circle(pen, {}, {0, s.y, 0}, {0, 0, s.z});
    circle(pen, {}, {0, 0, s.z}, {s.x, 0, 0});
  }
  void operator()(const Capsule& s) const {
    const float r = s.radius;
    for (const float side : {-1.0f, 1.0f}) {
      ring(pen, r, side * s.halfHeight);
      arc(pen, {0, side * s.halfHeight, 0}, {r, 0, 0}, {0, side * r, 0}, 0, kHalfTurn);
      arc(pen, {0, side * s.halfHeight, 0}, {0, 0, r}, {0, side * r, 0}, 0, kHalfTurn);
    }
    sides(pen, {r, -s.halfHeight}, {r, s.halfHeight});
  }
  void operator()(const Box& s) const { facesWire(pen, facesOf(s), s.rounding); }
  void operator()(const Cylinder& s) const {
    const float r = s.radius + s.rounding;
    for (const float side : {-1.0f, 1.0f}) {
      ring(pen, r, side * s.halfHeight);
      if (s.rounding > 0) ring(pen, s.radius, side * (s.halfHeight + s.rounding));
    }
    sides(pen, {r, -s.halfHeight}, {r, s.halfHeight});
  }
  void operator()(const Cone& s) const {
    const float r = s.rounding, c = std::cos(slopeOf(s)), d = std::sin(slopeOf(s));
    const Profile low{s.radius + r * c, -s.halfHeight + r * d}, high{r * c, s.halfHeight + r * d};
    ring(pen, low.radius, low.y);
    if (r > 0) {
      ring(pen, s.radius, -s.halfHeight - r);
      ring(pen, high.radius, high.y);
    }
    sides(pen, low, high);
  }
  void operator()(const Hull& s) const { facesWire(pen, facesOf(s), s.rounding); }
  void operator()(const HalfSpace&) const {
    const float h = pen.options.planeHalf;
    for (const float at : {-h, 0.0f, h}) {
      pen.line({-h, 0, at}, {h, 0, at});
      pen.line({at, 0, -h}, {at, 0, h});
    }
    pen.line({}, {0, pen.options.size, 0});
  }
  void operator()(const Mesh& s) const { surface(s); }
  void operator()(const HeightField& s) const { surface(s); }
  template <class Surface>
  void surface(const Surface& s) const {
    eachTriangle(s, [&](Vec3 a, Vec3 b, Vec3 c) {
      pen.line(a, b);
      pen.line(b, c);
      pen.line(c, a);
    });
  }
};

struct Solid {
  const DebugPen& pen;

  void operator()(const Sphere& s) const { lathe(pen, ball(s.radius, 0, pen.options.segments)); }
  void operator()(const Ellipsoid& s) const { lathe(pen, ball(1, 0, pen.options.segments), {s.x, s.y, s.z}); }
  void operator()(const Capsule& s) const { lathe(pen, ball(s.radius, s.halfHeight, pen.options.segments)); }
  void operator()(const Box& s) const { facesSolid(pen, facesOf(s), s.rounding); }
  void operator()(const Cylinder& s) const { lathe(pen, cylinder(s, pen.options.segments)); }
  void operator()(const Cone& s) const { lathe(pen, cone(s, pen.options.segments)); }
  void operator()(const Hull& s) const { facesSolid(pen, facesOf(s), s.rounding); }
  void operator()(const HalfSpace&) const {
    const float h = pen.options.planeHalf;
    pen.triangle({-h, 0, -h}, {-h, 0, h}, {h, 0, h});
    pen.triangle({-h, 0, -h}, {h, 0, h}, {h, 0, -h});
  }
  void operator()(const Mesh& s) const { surface(s); }
  void operator()(const HeightField& s) const { surface(s); }
  template <class Surface>
  void surface(const Surface& s) const {
    eachTriangle(s, [&](Vec3 a, Vec3 b, Vec3 c) { pen.triangle(a, b, c); });
  }
};

/// The support function of each shape about its origin.
struct Farthest {
  Vec3 d;

  float round() const { return std::sqrt(d.x * d.x + d.z * d.z); }
  float operator()(const Sphere& s) const { return s.radius * length(d); }
  float operator()(const Ellipsoid& s) const { return length(scaled(d, {s.x, s.y, s.z})); }
  float operator()(const Capsule& s) const { return s.halfHeight * std::fabs(d.y) + s.radius * length(d); }
  float operator()(const Box& s) const {
    return s.x * std::fabs(d.x) + s.y * std::fabs(d.y) + s.z * std::fabs(d.z) + s.rounding * length(d);
  }
  float operator()(const Cylinder& s) const {
    return s.radius * round() + s.halfHeight * std::fabs(d.y) + s.rounding * length(d);
  }
  float operator()(const Cone& s) const {
    return std::max(s.halfHeight * d.y, s.radius * round() - s.halfHeight * d.y) + s.rounding * length(d);
  }
  float operator()(const HalfSpace&) const { return 0; }
  float operator()(const Hull& s) const {
    float most = -INFINITY;
    for (const Vec3 v : s.data->vertices()) most = std::max(most, dot(d, scaled(v, s.scale)));
    return most + s.rounding * length(d);
  }
  float operator()(const Mesh& s) const { return surface(s); }
  float operator()(const HeightField& s) const { return surface(s); }
  template <class Surface>
  float surface(const Surface& s) const {
    float most = -INFINITY;
    eachTriangle(s, [&](Vec3 a, Vec3 b, Vec3 c) { most = std::max({most, dot(d, a), dot(d, b), dot(d, c)}); });
    return most;
  }
};

}  // namespace

void drawWire(const DebugPen& pen, const Geometry& geometry) { std::visit(Wire{pen}, geometry); }
void drawSolid(const DebugPen& pen, const Geometry& geometry) { std::visit(Solid{pen}, geometry); }

bool farthest(const Geometry& geometry, Vec3 d, float& distance) {
  if (std::holds_alternative<HalfSpace>(geometry)) return false;
  distance = std::visit(Farthest{d}, geometry);
  return std::isfinite(distance);
}

}  // namespace avbd
