// What is done with the fuzzer's bytes as a mesh file.
#pragma once

#include <avbd/avbd.h>

#include <cmath>

#include "fuzz/check.h"
#include "io/mesh_file.h"

namespace avbd::fuzz {

inline void readMeshInput(const uint8_t* data, size_t size, const char* kind) {
  MeshFile file;
  try {
    file = readMeshBytes(std::as_bytes(std::span(data, size)), kind, "fuzz");
  } catch (const FileError&) {
    return;
  }
  require(!file.triangles.empty(), "a mesh without triangles");
  for (const auto& triangle : file.triangles)
    for (const uint32_t corner : triangle) require(corner < file.vertices.size(), "a corner beyond the vertices");
  for (const Vec3 v : file.vertices)
    require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "a vertex that is not finite");
  try {
    makeHull({.points = file.vertices});
  } catch (const Error&) {
  }
  try {
    const auto mesh = makeMesh({.vertices = file.vertices, .triangles = file.triangles});
    require(mesh->triangleCount() == mesh->report().triangles, "triangles that are not counted");
  } catch (const Error&) {
  }
}

}  // namespace avbd::fuzz
