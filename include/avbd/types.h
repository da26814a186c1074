// Plain value types of the public API: vectors, rotations, poses.
#pragma once

#include <cmath>
#include <cstdint>

namespace avbd {

/// A direction, velocity or small offset; metres, metres per second, newtons ... as the field says.
struct Vec3 {
  float x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// A position. World positions are double so that worlds may be large; the solver works in float displacements.
struct Vec3d {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3d&, const Vec3d&) = default;
};

/// A rotation as a unit quaternion, w first.
struct Quat {
  float w = 1, x = 0, y = 0, z = 0;
  friend bool operator==(const Quat&, const Quat&) = default;
};

/// Position and rotation of a frame: in the world, or in a body's frame where a field says so.
struct Pose {
  Vec3d position{};
  Quat rotation{};
  friend bool operator==(const Pose&, const Pose&) = default;
};

/// Symmetric 3x3 matrix, e.g. an inertia tensor [kg m^2].
struct SymMat3 {
  float xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  friend bool operator==(const SymMat3&, const SymMat3&) = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(float s, Vec3 a) { return a * s; }
constexpr Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3d operator+(Vec3d a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3d operator-(Vec3d a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline double length(Vec3d a) { return std::sqrt(dot(a, a)); }
constexpr Vec3 toFloat(Vec3d a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }
constexpr Vec3d toDouble(Vec3 a) { return {a.x, a.y, a.z}; }

/// Product of rotations: first b, then a.
constexpr Quat operator*(Quat a, Quat b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
constexpr Quat conjugate(Quat q) { return {q.w, -q.x, -q.y, -q.z}; }
/// v turned by the unit quaternion q.
constexpr Vec3 rotate(Quat q, Vec3 v) {
  const Vec3 u{q.x, q.y, q.z};
  const Vec3 t = 2.0f * cross(u, v);
  return v + q.w * t + cross(u, t);
}
constexpr Vec3d rotate(Quat q, Vec3d v) {
  const double tx = 2 * (q.y * v.z - q.z * v.y), ty = 2 * (q.z * v.x - q.x * v.z), tz = 2 * (q.x * v.y - q.y * v.x);
  return {v.x + q.w * tx + (q.y * tz - q.z * ty), v.y + q.w * ty + (q.z * tx - q.x * tz),
          v.z + q.w * tz + (q.x * ty - q.y * tx)};
}
/// Pose of b's child frame: a * b maps a point given in b's frame to the frame that a is given in.
constexpr Pose operator*(const Pose& a, const Pose& b) {
  return {a.position + rotate(a.rotation, b.position), a.rotation * b.rotation};
}
constexpr Pose inverse(const Pose& a) {
  const Quat q = conjugate(a.rotation);
  const Vec3d p = rotate(q, a.position);
  return {{-p.x, -p.y, -p.z}, q};
}

}  // namespace avbd
