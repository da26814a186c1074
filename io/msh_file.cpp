// MuJoCo's MSH: four int32 counts (vertices, normals, texture coordinates, faces), then their float32 and int32 values.
#include <cmath>

#include "io/mesh_file_parts.h"

namespace avbd::mesh_file {

namespace {

constexpr size_t kHead = 16;

struct Counts {
  uint64_t vertices, normals, texcoords, faces;
  uint64_t bytes() const { return kHead + 12 * vertices + 12 * normals + 8 * texcoords + 12 * faces; }
};

Counts countsOf(std::string_view bytes) { return {word(bytes, 0), word(bytes, 4), word(bytes, 8), word(bytes, 12)}; }

}  // namespace

bool isMsh(std::string_view bytes) { return bytes.size() >= kHead && countsOf(bytes).bytes() == bytes.size(); }

MeshFile readMsh(std::string_view bytes, const std::string& name) {
  const auto fail = [&](size_t at, const std::string& message) {
    throw FileError(name + ": byte " + std::to_string(at) + ": " + message, name);
  };
  if (bytes.size() < kHead) {
    fail(bytes.size(), "size = " + std::to_string(bytes.size()) + ": the head must have 16 bytes");
  }
  const Counts counts = countsOf(bytes);
  if (counts.bytes() != bytes.size()) {
    fail(0, "size = " + std::to_string(bytes.size()) + ": must be " + std::to_string(counts.bytes()) +
                " bytes, as its " + std::to_string(counts.vertices) + " vertices, " + std::to_string(counts.normals) +
                " normals, " + std::to_string(counts.texcoords) + " texture coordinates and " +
                std::to_string(counts.faces) + " faces need");
  }
  MeshFile out;
  out.vertices.reserve(counts.vertices);
  for (uint64_t i = 0; i < counts.vertices; ++i) {
    const size_t at = kHead + 12 * i;
    const Vec3 v{real(bytes, at), real(bytes, at + 4), real(bytes, at + 8)};
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
      fail(at, "vertex " + std::to_string(i) + " = (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " +
                   std::to_string(v.z) + "): must be finite");
    }
    out.vertices.push_back(v);
  }
  const size_t faces = bytes.size() - 12 * counts.faces;
  out.triangles.reserve(counts.faces);
  for (uint64_t i = 0; i < counts.faces; ++i) {
    std::array<uint32_t, 3> triangle;
    for (size_t k = 0; k < 3; ++k) {
      const size_t at = faces + 12 * i + 4 * k;
      triangle[k] = word(bytes, at);
      if (triangle[k] >= counts.vertices) {
        fail(at, "face " + std::to_string(i) + " = " + std::to_string(static_cast<int32_t>(triangle[k])) +
                     ": the vertex must be 0 .. " + std::to_string(static_cast<int64_t>(counts.vertices) - 1));
      }
    }
    out.triangles.push_back(triangle);
  }
  return out;
}

}  // namespace avbd::mesh_file
