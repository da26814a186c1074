// What is done with a soft mesh that a reader made of the fuzzer's bytes.
#pragma once

#include <avbd/avbd.h>

#include <cmath>

#include "fuzz/check.h"
#include "io/soft_mesh_file.h"

namespace avbd::fuzz {

template <class Read>
void readSoftMeshInput(Read&& read) {
  SoftMeshFile file;
  try {
    file = read();
  } catch (const FileError&) {
    return;
  }
  require(!file.tets.empty() || !file.triangles.empty(), "a soft mesh without elements");
  for (const auto& tet : file.tets)
    for (const uint32_t corner : tet) require(corner < file.points.size(), "a corner beyond the points");
  for (const auto& triangle : file.triangles)
    for (const uint32_t corner : triangle) require(corner < file.points.size(), "a corner beyond the points");
  for (const Vec3 v : file.points)
    require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "a point that is not finite");
  try {
    const auto mesh = makeSoftMesh(file, "fuzz");
    const SoftMeshQuality quality = qualityOf(*mesh);
    require(quality.leastHeight > 0, "an element without height");
    require(quality.pieces > 0, "a mesh of no piece");
    const SurfaceBinding binding({mesh, mesh->points()});
    require(binding.farthest() < 1, "a point of the mesh far from it");
  } catch (const FileError&) {
  }
}

inline void readSoftMeshInput(const uint8_t* data, size_t size, const char* kind) {
  readSoftMeshInput([&] { return readSoftMeshBytes(std::as_bytes(std::span(data, size)), kind, "fuzz"); });
}

}  // namespace avbd::fuzz
