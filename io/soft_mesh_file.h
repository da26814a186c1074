// Reads tetrahedra and triangles of soft bodies from Gmsh's .msh, VTK's .vtk and TetGen's .node and .ele files.
#pragma once

#include <avbd/soft_mesh.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_error.h"

namespace avbd {

/// What a file has, unscaled and unchecked but for the indices. Elements of second order are taken by their corners.
struct SoftMeshFile {
  std::vector<Vec3> points;
  std::vector<std::array<uint32_t, 4>> tets;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<std::string> notes;  ///< what was left out, one line each
};

/// Whether readSoftMeshFile is the reader for it: by the extension (.vtk, .node, .ele in any case), and of .msh, which
/// is MuJoCo's too, by the content.
bool isSoftMeshFile(const std::filesystem::path& file);

/// Gmsh 2.2 and 4.1, legacy VTK unstructured grids, both as text and binary; of TetGen either file, the other one lies
/// beside it. Throws FileError: unknown kind, missing file, broken syntax, a version or numbers of a kind that is not
/// read, an index of no point, numbers that are not finite, neither tetrahedron nor triangle, more than 256 MiB.
SoftMeshFile readSoftMeshFile(const std::filesystem::path& file);
/// The same from memory. kind: "msh", "vtk".
SoftMeshFile readSoftMeshBytes(std::span<const std::byte> bytes, std::string_view kind,
                               std::string_view nameForMessages);
/// The same of a pair of TetGen's files. The name is without the extension.
SoftMeshFile readTetgenBytes(std::span<const std::byte> node, std::span<const std::byte> ele,
                             std::string_view nameForMessages);

/// A solid of its tetrahedra, or cloth of its triangles where it has none. Throws FileError for what makeTetMesh and
/// makeClothMesh refuse.
std::shared_ptr<const SoftMeshData> makeSoftMesh(const SoftMeshFile& mesh, std::string_view nameForMessages);

}  // namespace avbd
