// Shared geometry for the sessions (surfaces.h).
#include <array>

#include "fuzz/surfaces.h"

namespace avbd::fuzz {

const std::shared_ptr<const HullData>& someHull() {
  static const auto hull = [] {
    const std::vector<Vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},         {0, -1, 0},
                                   {0, 0, 1}, {0, 0, -1}, {0.7f, 0.7f, 0.7f}};
    return makeHull({.points = points});
  }();
  return hull;
}

const std::shared_ptr<const HullData>& roundHull() {
  static const auto hull = [] {
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i) {
      const Vec3 p{static_cast<float>(i * 37 % 101) - 50, static_cast<float>(i * 59 % 103) - 51,
                   static_cast<float>(i * 83 % 107) - 53};
      points.push_back(p * (1 / length(p)));
    }
    return makeHull({.points = points});
  }();
  return hull;
}

const std::shared_ptr<const MeshData>& someMesh() {
  static const auto mesh = [] {
    const std::vector<Vec3> vertices{{-4, 0, -4}, {4, 0, -4}, {4, 0.5f, 4}, {-4, 0, 4}, {0, -1, 0}};
    const std::vector<std::array<uint32_t, 3>> triangles{{4, 1, 0}, {4, 2, 1}, {4, 3, 2}, {4, 0, 3}};
    return makeMesh({.vertices = vertices, .triangles = triangles});
  }();
  return mesh;
}

const std::shared_ptr<const MeshData>& thinMesh() {
  static const auto mesh = [] {
    const std::vector<Vec3> vertices{{-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2}, {0, 0, 2.00001f}, {0, 1, 0}};
    const std::vector<std::array<uint32_t, 3>> triangles{{0, 2, 1}, {0, 3, 2}, {2, 3, 4}, {0, 1, 5}};
    const std::vector<uint16_t> materials{0, 1, 0, 1};
    return makeMesh({.vertices = vertices, .triangles = triangles, .materials = materials, .doubleSided = true});
  }();
  return mesh;
}

const std::shared_ptr<const HeightFieldData>& someField() {
  static const auto field = [] {
    std::vector<float> heights;
    for (int i = 0; i < 25; ++i) heights.push_back(static_cast<float>(i * 7 % 5) * 0.25f);
    std::vector<uint16_t> materials(16, 0);
    materials[5] = HeightFieldDef::kHole;
    materials[6] = 1;
    return makeHeightField(
        {.columns = 5, .rows = 5, .spacingX = 2, .spacingZ = 2, .heights = heights, .materials = materials});
  }();
  return field;
}

}  // namespace avbd::fuzz
