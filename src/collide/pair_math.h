// Small matrix and clamp functions that the pair functions share. Only + - * / sqrt and selects.
#pragma once

#include <avbd/types.h>

namespace avbd {

/// m[row][column].
struct Mat3 {
  float m[3][3];
};

inline Mat3 matrix(Quat q) {
  const float x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const float xx = q.x * x2, yy = q.y * y2, zz = q.z * z2, xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
  const float wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  return {{{1 - (yy + zz), xy - wz, xz + wy}, {xy + wz, 1 - (xx + zz), yz - wx}, {xz - wy, yz + wx, 1 - (xx + yy)}}};
}

inline Vec3 mul(const Mat3& a, Vec3 v) {
  return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
          a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}

/// Transposed matrix times v.
inline Vec3 mulT(const Mat3& a, Vec3 v) {
  return {a.m[0][0] * v.x + a.m[1][0] * v.y + a.m[2][0] * v.z, a.m[0][1] * v.x + a.m[1][1] * v.y + a.m[2][1] * v.z,
          a.m[0][2] * v.x + a.m[1][2] * v.y + a.m[2][2] * v.z};
}

inline Vec3 column(const Mat3& a, int i) { return {a.m[0][i], a.m[1][i], a.m[2][i]}; }

inline float clampTo(float x, float low, float high) { return x < low ? low : (x > high ? high : x); }
inline Vec3 clampTo(Vec3 v, Vec3 h) {
  return {clampTo(v.x, -h.x, h.x), clampTo(v.y, -h.y, h.y), clampTo(v.z, -h.z, h.z)};
}
inline float magnitude(float x) { return x < 0 ? -x : x; }
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }

/// Vectors whose component is picked at run time.
struct Axes {
  float c[3];
  float& operator[](int i) { return c[i]; }
  float operator[](int i) const { return c[i]; }
};
inline Axes axes(Vec3 v) { return {{v.x, v.y, v.z}}; }
inline Vec3 vec(const Axes& a) { return {a.c[0], a.c[1], a.c[2]}; }

/// The two other axes, so that (i, kNext[i], kLast[i]) is right-handed.
inline constexpr int kNext[3] = {1, 2, 0};
inline constexpr int kLast[3] = {2, 0, 1};

/// Distances below this part of the shapes' size have no usable direction in float.
inline constexpr float kNoDirection = 1e-6f;

}  // namespace avbd
