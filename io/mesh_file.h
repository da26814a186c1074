// Reads triangles from OBJ, STL (text and binary) and MuJoCo's MSH files.
#pragma once

#include <avbd/types.h>

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_error.h"

namespace avbd {

/// Triangles as a file has them, unscaled, anticlockwise seen from outside; polygons are cut into triangles.
struct MeshFile {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<std::string> notes;  ///< what was left out or repaired, one line each
};

/// By the extension (.obj, .stl, .msh in any case; an STL whose extension lies is recognised by its content). Throws
/// FileError: unknown kind, missing file, broken syntax, an index out of range, numbers that are not finite, no
/// triangle at all, more than 64 MiB.
MeshFile readMeshFile(const std::filesystem::path& file);
/// The same from memory. kind: "obj", "stl", "msh".
MeshFile readMeshBytes(std::span<const std::byte> bytes, std::string_view kind, std::string_view nameForMessages);

}  // namespace avbd
