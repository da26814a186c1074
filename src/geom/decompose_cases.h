// Closed meshes to decompose, for tests and benchmarks.
#pragma once

#include <avbd/types.h>

#include <array>
#include <cmath>
#include <vector>

namespace avbd {

struct TestMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;

  void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
  void add(const TestMesh& other, Vec3 at) {
    const uint32_t first = static_cast<uint32_t>(vertices.size());
    for (const Vec3& v : other.vertices) vertices.push_back(v + at);
    for (const auto& t : other.triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
};

inline TestMesh boxMesh(Vec3 half) {
  TestMesh m;
  for (int i = 0; i < 8; ++i) {
    m.vertices.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
  }
  m.quad(0, 4, 6, 2);
  m.quad(1, 3, 7, 5);
  m.quad(0, 1, 5, 4);
  m.quad(2, 6, 7, 3);
  m.quad(0, 2, 3, 1);
  m.quad(4, 5, 7, 6);
  return m;
}

inline TestMesh tetrahedronMesh() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// An L of arms 1 and thickness 0.3, 0.4 deep.
inline TestMesh lMesh() {
  const Vec3 outline[6] = {{0, 0, 0}, {1, 0, 0}, {1, 0.3f, 0}, {0.3f, 0.3f, 0}, {0.3f, 1, 0}, {0, 1, 0}};
  TestMesh m;
  for (float z : {0.0f, 0.4f}) {
    for (const Vec3& p : outline) m.vertices.push_back({p.x, p.y, z});
  }
  for (uint32_t i = 0; i < 6; ++i) m.quad(i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6);
  for (const auto& t : {std::array<uint32_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    m.triangles.push_back({t[2], t[1], t[0]});
    m.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  return m;
}

/// A closed outline of (radius, height), anticlockwise with the axis on its left, turned about the y axis. Radii > 0.
inline TestMesh turnedMesh(const std::vector<Vec3>& outline, int around) {
  TestMesh m;
  const uint32_t n = static_cast<uint32_t>(outline.size());
  for (int k = 0; k < around; ++k) {
    const float a = 6.28318531f * static_cast<float>(k) / static_cast<float>(around);
    for (const Vec3& p : outline) m.vertices.push_back({p.x * std::cos(a), p.y, p.x * std::sin(a)});
  }
  for (uint32_t k = 0; k < static_cast<uint32_t>(around); ++k) {
    const uint32_t a = k * n, b = (k + 1) % static_cast<uint32_t>(around) * n;
    for (uint32_t i = 0; i < n; ++i) m.quad(a + i, a + (i + 1) % n, b + (i + 1) % n, b + i);
  }
  return m;
}

inline TestMesh torusMesh(float radius, float tube, int around, int about) {
  std::vector<Vec3> outline;
  for (int i = 0; i < about; ++i) {
    const float a = 6.28318531f * static_cast<float>(i) / static_cast<float>(about);
    outline.push_back({radius + tube * std::cos(a), tube * std::sin(a), 0});
  }
  return turnedMesh(outline, around);
}

/// Half a ball's shell with a small hole in the bottom: a bowl of thickness 0.1.
inline TestMesh bowlMesh() {
  std::vector<Vec3> outline;
  for (int i = 0; i <= 12; ++i) {
    const float a = -1.45f + 1.45f * static_cast<float>(i) / 12;
    outline.push_back({std::cos(a), std::sin(a), 0});
  }
  for (int i = 12; i >= 0; --i) {
    const float a = -1.45f + 1.45f * static_cast<float>(i) / 12;
    outline.push_back({0.9f * std::cos(a), 0.9f * std::sin(a), 0});
  }
  return turnedMesh(outline, 32);
}

}  // namespace avbd
