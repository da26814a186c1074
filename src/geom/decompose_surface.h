// The surface of a solid to decompose: welded triangles, what is open, the signed distance of a point.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/hull_math.h"

namespace avbd {

class ClosedSurface {
 public:
  /// Welds equal vertices and drops triangles without area or with a twin.
  ClosedSurface(std::span<const Vec3> vertices, std::span<const std::array<uint32_t, 3>> triangles);

  struct OpenEdges {
    uint32_t count = 0;
    std::string first;  ///< the first one in words, with the vertices' places
  };
  const OpenEdges& openEdges() const { return open_; }

  size_t size() const { return triangles_.size(); }
  std::array<Vec3d, 3> triangle(size_t i) const {
    return {vertices_[triangles_[i][0]], vertices_[triangles_[i][1]], vertices_[triangles_[i][2]]};
  }
  Vec3d lower() const { return lower_; }
  Vec3d upper() const { return upper_; }
  double volume() const;

  struct Nearest {
    double distance = 1e300;
    bool behind = false;  ///< the point lies behind the surface there: inside, where the surface is closed
  };
  Nearest nearest(Vec3d p) const;
  bool isWithin(Vec3d p, double distance) const;  ///< whether the surface comes so near

 private:
  struct Node {
    Vec3d lower, upper;
    uint32_t first = 0, count = 0;  // leaf: triangles in order_; inner: count 0, children first and first + 1
  };
  struct Found {
    double square = 1e300;
    uint32_t triangle = 0;
    Vec3d at;
  };
  /// The nearest triangle, or the first that is found as near as `enough` (squared).
  Found search(Vec3d p, double enough) const;
  void findOpenEdges();
  void findNormals();
  void build(uint32_t node, uint32_t begin, uint32_t end);
  bool isBehind(uint32_t triangle, Vec3d at, Vec3d p) const;

  std::vector<Vec3d> vertices_;
  std::vector<std::array<uint32_t, 3>> triangles_;
  std::vector<Vec3d> faceNormals_, vertexNormals_;
  std::vector<std::array<Vec3d, 3>> edgeNormals_;  // of the edge from corner i to i + 1
  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
  Vec3d lower_, upper_;
  OpenEdges open_;
};

}  // namespace avbd
