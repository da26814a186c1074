// For the tests: worlds of shapes of every type, whole and each shape in a world of its own.
#pragma once

#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>
#include <avbd/world.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace avbd {

class QueryRandom {
 public:
  explicit QueryRandom(uint32_t seed) : random_(seed) {}
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  float size(double low = 0.2, double high = 1) { return static_cast<float>(within(low, high)); }
  int below(int n) { return static_cast<int>(random_() % static_cast<uint32_t>(n)); }
  Vec3d point(double reach) { return {within(-reach, reach), within(-reach, reach), within(-reach, reach)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = toFloat(point(1));
      const float l = length(v);
      if (l > 0.1f && l < 1) return v * (1 / l);
    }
  }
  Quat rotation() {
    std::normal_distribution<double> n;
    const double w = n(random_), x = n(random_), y = n(random_), z = n(random_);
    const double k = 1 / std::sqrt(w * w + x * x + y * y + z * z);
    return {float(w * k), float(x * k), float(y * k), float(z * k)};
  }

 private:
  std::mt19937 random_;
};

inline std::shared_ptr<const HullData> rockHull(QueryRandom& random, int points = 20) {
  std::vector<Vec3> cloud;
  for (int i = 0; i < points; ++i) cloud.push_back(random.direction() * random.size(0.5, 0.9));
  return makeHull({.points = cloud});
}

inline std::shared_ptr<const MeshData> bumpyMesh(int n, float cell, QueryRandom& random) {
  std::vector<Vec3> v;
  std::vector<std::array<uint32_t, 3>> t;
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c)
      v.push_back({(float(c) - 0.5f * float(n)) * cell, random.size(0, 0.5), (float(r) - 0.5f * float(n)) * cell});
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      const uint32_t a = uint32_t(r * (n + 1) + c), b = a + 1, d = a + uint32_t(n) + 1, e = d + 1;
      t.push_back({a, d, e});
      t.push_back({a, e, b});
    }
  }
  return makeMesh({.vertices = v, .triangles = t});
}

inline std::shared_ptr<const HeightFieldData> hills(int n, float cell, QueryRandom& random) {
  std::vector<float> heights;
  for (int i = 0; i < n * n; ++i) heights.push_back(random.size(0, 0.6));
  return makeHeightField({.columns = n, .rows = n, .spacingX = cell, .spacingZ = cell, .heights = heights});
}

inline Geometry convexGeometry(QueryRandom& random, int type) {
  const float a = random.size(), b = random.size(), c = random.size();
  switch (type) {
    case 0:
      return Sphere{a};
    case 1:
      return Capsule{0.5f * a, b};
    case 2:
      return Box{a, b, c};
    case 3:
      return Box{a, b, c, 0.1f};
    case 4:
      return Cylinder{a, b};
    case 5:
      return Cone{a, b};
    case 6:
      return Ellipsoid{a, b, c};
    case 7:
      return Hull{rockHull(random)};
    case 8:
      return Cylinder{a, b, 0.1f};
    case 9:
      return Cone{a, b, 0.1f};
    default:
      return Hull{rockHull(random), {1, -0.5f, 1.5f}, 0.05f};
  }
}
inline constexpr int kConvexTypes = 11;

/// A world of many bodies and, of each, a world with it alone.
struct QueryWorlds {
  World all;
  std::vector<BodyDef> defs;
  std::vector<BodyId> bodies;
  std::vector<ShapeId> shapes;
  std::vector<std::unique_ptr<World>> single;
  size_t onTriangles = 0;  ///< counted by the tests

  void add(const BodyDef& def) {
    defs.push_back(def);
    bodies.push_back(all.create(def));
    for (const ShapeId id : all.shapes(bodies.back())) shapes.push_back(id);
    single.push_back(std::make_unique<World>());
    single.back()->create(def);
  }
  explicit QueryWorlds(uint32_t seed, int count, Vec3d center, double reach) {
    QueryRandom random(seed);
    for (int i = 0; i < count; ++i) {
      BodyDef def;
      def.type = static_cast<BodyType>(random.below(3));
      def.position = center + random.point(reach);
      def.rotation = random.rotation();
      ShapeDef shape;
      shape.geometry = convexGeometry(random, i % kConvexTypes);
      shape.isTrigger = random.below(5) == 0;
      shape.filter.category = 1u << random.below(3);
      shape.filter.mask = random.below(4) ? 0xffffffffu : 2u;
      if (random.below(3) == 0) shape.pose = {random.point(0.5), random.rotation()};
      def.shapes = {shape};
      def.massProperties = MassProperties{};
      add(def);
    }
  }
  void addSurfaces(uint32_t seed, Vec3d center) {
    QueryRandom random(seed);
    BodyDef def;
    def.type = BodyType::Static;
    def.rotation = random.rotation();
    def.position = center;
    def.shape = Mesh{bumpyMesh(12, 0.7f, random), {1, 2, 1.5f}};
    add(def);
    def.rotation = random.rotation();
    def.position = center + Vec3d{1, -3, 0};
    def.shape = HeightField{hills(14, 0.6f, random), {1, 2, 1}};
    add(def);
    def.rotation = random.rotation();
    def.position = center + Vec3d{0, -12, 0};
    def.shape = HalfSpace{};
    add(def);
  }
};

}  // namespace avbd
