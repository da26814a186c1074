// What articulations compute with: rotations and poses in double, sines and rotation vectors that are the same on every
// platform.
#pragma once

#include <avbd/types.h>

#include <cmath>

#include "geom/hull_math.h"
#include "geom/sym_mat3d.h"

namespace avbd::articulation {

struct Quatd {
  double w = 1, x = 0, y = 0, z = 0;
};

/// As Pose.
struct Posed {
  Vec3d position;
  Quatd rotation;
};

/// Linear and angular part of a velocity, an acceleration, or a force and its torque; world axes.
struct Spatial {
  Vec3d linear, angular;
};

constexpr Vec3d operator-(Vec3d a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3d& operator+=(Vec3d& a, Vec3d b) { return a = a + b; }
constexpr Spatial operator+(const Spatial& a, const Spatial& b) { return {a.linear + b.linear, a.angular + b.angular}; }
constexpr Spatial operator*(const Spatial& a, double s) { return {a.linear * s, a.angular * s}; }
constexpr double dot(const Spatial& a, const Spatial& b) {
  return avbd::dot(a.linear, b.linear) + avbd::dot(a.angular, b.angular);
}
/// The same motion seen `arm` farther on.
constexpr Spatial movedBy(const Spatial& motion, Vec3d arm) {
  return {motion.linear + cross(motion.angular, arm), motion.angular};
}
/// The same force about a point that it is `arm` away from.
constexpr Spatial forceSeenFrom(const Spatial& force, Vec3d arm) {
  return {force.linear, force.angular + cross(arm, force.linear)};
}

constexpr Quatd operator*(Quatd a, Quatd b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
constexpr Quatd conjugate(Quatd q) { return {q.w, -q.x, -q.y, -q.z}; }
constexpr Vec3d rotate(Quatd q, Vec3d v) {
  const Vec3d u{q.x, q.y, q.z}, t = cross(u, v) * 2;
  return v + t * q.w + cross(u, t);
}
constexpr Posed operator*(const Posed& a, const Posed& b) {
  return {a.position + rotate(a.rotation, b.position), a.rotation * b.rotation};
}
constexpr Posed inverse(const Posed& a) {
  const Quatd q = conjugate(a.rotation);
  return {-rotate(q, a.position), q};
}
/// With length 1: floats keep it to 1e-7 only.
inline Posed toDouble(const Pose& pose) {
  const Quatd q{pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
  const double s = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {pose.position, {q.w * s, q.x * s, q.y * s, q.z * s}};
}
inline Pose toFloat(const Posed& pose) {
  const Quatd& q = pose.rotation;
  return {pose.position,
          {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)}};
}

/// I v.
constexpr Vec3d times(const SymMat3d& m, Vec3d v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

struct SinCos {
  double sin, cos;
};
SinCos sinCos(double angle);             ///< to 1e-15 for angles within 1e6
Quatd rotationOf(Vec3d rotationVector);  ///< the turn by its length about it
Vec3d rotationVectorOf(Quatd rotation);  ///< the shortest; length at most pi

/// How turning goes with the rate of a rotation vector s: w = s' + a s x s' + b s x (s x s'), and of a and b the slopes
/// da/ds = aSlope s, db/ds = bSlope s.
struct TurningFactors {
  double a, b, aSlope, bSlope;
};
TurningFactors turningFactors(Vec3d rotationVector);

}  // namespace avbd::articulation
