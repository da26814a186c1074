// Points and edges of a triangulated surface, each standing with one face.
//
// Two surfaces meet where a point meets a face or an edge an edge. Who asks all features of two faces that are near
// each other would ask most of them several times, as faces share them: so a face asks only for those that it owns.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace avbd {

struct SurfaceFeatures {
  static constexpr uint32_t kNoFace = 0xffffffffu;
  std::vector<std::array<uint32_t, 2>> edges;      ///< points, the lower first
  std::vector<std::array<uint32_t, 2>> edgeFaces;  ///< those at an edge; kNoFace: a rim
  std::vector<std::array<uint32_t, 3>> faceEdges;  ///< by face: edge from corner k to the next
  std::vector<uint8_t> owned;                      ///< by face: bit k corner k, bit 3 + k edge k

  bool ownsCorner(uint32_t face, uint32_t k) const { return owned[face] >> k & 1; }
  bool ownsEdge(uint32_t face, uint32_t k) const { return owned[face] >> (3 + k) & 1; }
};

/// Of a surface on `points` points, of whose edges none is in more than two faces.
SurfaceFeatures surfaceFeatures(size_t points, std::span<const std::array<uint32_t, 3>> faces);

}  // namespace avbd
