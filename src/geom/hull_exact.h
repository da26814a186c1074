// Quickhull whose every decision is exact.
//
// Points are snapped to an integer grid of 2^39 cells along the largest extent (1e-12 of it, far below a float's own
// rounding). A plane's normal and the side of a point are then determinants of integers that fit 128 bits: no
// tolerance, no inconsistent topology, whatever the points. Distances in double (error below 2^-7 cell) decide all but
// close cases.
//
// The farthest point of all comes first, so stopping at any count leaves a good approximation from inside. A face that
// the new point lies exactly in counts as visible: that is what the point moved a little outwards would see, hence the
// region seen is a disc and no new triangle is flat. Points wait in the list of a face that they lie above; of a
// removed face they go to the new face that they lie farthest above. A point above a removed face that is still outside
// lies above a new one (the plane through a horizon edge and the new point is a positive combination of the two old
// ones). Ties go to the lexicographically smaller point and faces are made in an order that only the geometry gives:
// the order of the points given does not matter.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/hull_math.h"

namespace avbd {

/// Maps points to the grid and back.
class HullGrid {
 public:
  HullGrid(Vec3d lower, Vec3d upper);
  Vec3d toGrid(Vec3d p) const;
  double toGrid(double distance) const { return distance * scale_; }
  double fromGrid(double distance) const { return distance / scale_; }

 private:
  Vec3d center_;
  double scale_ = 1;  // a power of two
};

/// Sign of the volume of tetrahedron abcd, of grid points: > 0 where d lies on the side that sees abc anticlockwise.
int exactSide(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

class ExactHull {
 public:
  /// Grid points; kept by reference.
  explicit ExactHull(const std::vector<Vec3d>& points) : points_(points) {}

  enum class Flat { No, Point, Line, Plane };
  /// Starts with a tetrahedron. Refuses points that lie within `tolerance` of a point, line or plane.
  Flat begin(double tolerance);
  /// Adds points, the farthest first, while the farthest lies more than `tolerance` outside (by Euclid) and the hull
  /// has fewer than `limit` vertices.
  void grow(double tolerance, int limit);

  struct Triangle {
    std::array<uint32_t, 3> vertex;  ///< indices of points, anticlockwise seen from outside
    std::array<uint32_t, 3> across;  ///< triangle beyond the edge from vertex[i] to vertex[i + 1]
  };
  std::vector<Triangle> triangles() const;
  int vertexCount() const { return vertexCount_; }
  /// Farthest that one of the points lies outside these triangles, in cells. They are a hull of some of the vertices
  /// and become this hull.
  double errorOf(const std::vector<Triangle>& triangles);

 private:
  static constexpr uint32_t kNone = ~0u;
  struct Face {
    std::array<uint32_t, 3> vertex, across;  // vertices by arrival
    Vec3d normal;                            // unit
    uint32_t first = kNone;                  // points above: a list through next_
    uint32_t farthest = kNone;
    double distance = 0;  // of `farthest`
    bool alive = true, seen = false;
  };
  struct Waiting {
    uint32_t point = kNone, face = kNone;
    double distance = 0;
  };
  struct Rim {
    uint32_t from = 0, to = 0;  // edge of the horizon
    uint32_t beyond = kNone;    // face that stays
  };

  const Vec3d& at(uint32_t vertex) const { return points_[vertexPoint_[vertex]]; }
  uint32_t addFace(uint32_t a, uint32_t b, uint32_t c);
  double above(const Face& face, uint32_t point) const { return dot(face.normal, points_[point] - at(face.vertex[0])); }
  bool sees(uint32_t point, const Face& face) const;
  bool isFarther(double distance, uint32_t point, double than, uint32_t other) const;
  void assign(uint32_t point);
  void insert(uint32_t point, uint32_t face);
  void findVisible(uint32_t point, uint32_t face);
  void findHorizon();
  void makeCone(uint32_t apex);
  Waiting farthestByPlane() const;
  Waiting farthestByEuclid() const;

  const std::vector<Vec3d>& points_;
  std::vector<uint32_t> vertexPoint_;  // by arrival: which point
  std::vector<Face> faces_;
  std::vector<uint32_t> free_;  // dead faces to use again
  std::vector<uint32_t> next_;  // after a waiting point
  std::vector<uint32_t> visible_, fresh_;
  std::vector<Rim> rim_;
  int vertexCount_ = 0;
};

}  // namespace avbd
