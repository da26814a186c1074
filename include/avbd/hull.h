// Convex hulls: made once from points, shared by any number of shapes and worlds.
#pragma once

#include <avbd/body.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace avbd {

/// Points to wrap.
struct HullDef {
  std::span<const Vec3> points;  ///< at least four that do not lie in one plane [m]
  /// [m] >= 0: points that lie no farther than this outside the result may be left out, and faces that differ by less
  /// are merged. 0 takes 1e-4 of the points' largest extent.
  float tolerance = 0;
  int maxVertices = 64;  ///< 4 .. 255: beyond, the vertices that matter least are left out
};

/// A convex polyhedron. Does not change once made; threads and worlds may share it.
class HullData {
 public:
  /// Plane normal . p = offset, normal unit and outwards; `count` vertices from loop[first] on, anticlockwise seen from
  /// outside.
  struct Face {
    Vec3 normal;
    float offset = 0;
    uint16_t first = 0, count = 0;
  };
  /// Two vertices, and the faces to the left (seen from outside, going from vertex[0] to vertex[1]) and to the right.
  struct Edge {
    uint8_t vertex[2] = {};
    uint16_t face[2] = {};
  };

  std::span<const Vec3> vertices() const { return vertices_; }  ///< [m], at most 255
  std::span<const Face> faces() const { return faces_; }
  std::span<const uint8_t> loops() const { return loops_; }  ///< vertices of all faces
  std::span<const Edge> edges() const { return edges_; }
  /// Vertices at the other ends of this vertex's edges, ascending.
  std::span<const uint8_t> neighbors(int vertex) const {
    return std::span(neighbors_).subspan(neighborFirst_[vertex], neighborFirst_[vertex + 1] - neighborFirst_[vertex]);
  }
  /// Farthest that a given point lies outside [m]: 0 unless points were left out.
  float error() const { return error_; }
  /// Mass, centre and inertia about the centre, at this density [kg/m^3].
  MassProperties massProperties(float density) const;
  /// Hash of the vertices and faces: equal hulls have equal hashes.
  uint64_t contentHash() const { return hash_; }
  Vec3 lower() const { return lower_; }  ///< bounds
  Vec3 upper() const { return upper_; }
  /// A point well inside, and the radius of a ball about it that fits inside.
  Vec3 center() const { return center_; }
  float innerRadius() const { return innerRadius_; }

 private:
  friend class HullFactory;  // src/geom: the only door to a hull
  HullData() = default;
  std::vector<Vec3> vertices_;
  std::vector<Face> faces_;
  std::vector<uint8_t> loops_;
  std::vector<Edge> edges_;
  std::vector<uint8_t> neighbors_;       ///< of all vertices
  std::vector<uint16_t> neighborFirst_;  ///< by vertex, and the end
  Vec3 lower_, upper_, center_;
  float innerRadius_ = 0, error_ = 0;
  double volume_ = 0;
  Vec3d massCenter_;
  std::array<double, 6> second_{};  ///< integral of r r^T about massCenter_: xx yy zz xy xz yz
  uint64_t hash_ = 0;
};

/// The convex hull of points. Throws Error for fewer than four points, points that are not finite, are beyond 1e6, or
/// lie within `tolerance` of one point, line or plane.
std::shared_ptr<const HullData> makeHull(const HullDef& def);

}  // namespace avbd
