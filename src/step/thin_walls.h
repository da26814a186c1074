// What tests of continuous collision share.
#pragma once

#include <avbd/avbd.h>

#include <array>
#include <vector>

namespace avbd {

inline constexpr float kDt = 1.0f / 60;

inline WorldDef weightless() {
  WorldDef def;
  def.gravity = {};
  return def;
}

/// Two triangles in the plane x = 0.
inline Mesh sheet(float size, bool doubleSided) {
  const std::vector<Vec3> v{{0, -size, -size}, {0, -size, size}, {0, size, size}, {0, size, -size}};
  const std::vector<std::array<uint32_t, 3>> t{{0, 1, 2}, {0, 2, 3}};
  return Mesh{makeMesh({.vertices = v, .triangles = t, .doubleSided = doubleSided})};
}

}  // namespace avbd
