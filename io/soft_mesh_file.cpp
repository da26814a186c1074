// Files of soft meshes: opening, which kind it is, and the mesh of what they have.
#include "io/soft_mesh_file.h"

#include <avbd/error.h>

#include <fstream>

#include "io/soft_mesh_file_parts.h"

namespace avbd {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxBytes = size_t{256} << 20;

std::string lowerCase(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  return text;
}

void checkSize(uint64_t size, const std::string& name) {
  if (size == 0) throw FileError(name + ": the file is empty", name);
  if (size > kMaxBytes)
    throw FileError(name + ": size = " + std::to_string(size) + ": must be at most " + std::to_string(kMaxBytes) +
                        " bytes (256 MiB)",
                    name);
}

std::vector<std::byte> bytesOf(const fs::path& file) {
  const std::string name = file.string();
  std::error_code error;
  // Devices and pipes could go on for ever.
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw FileError(name + ": no such file", name);
  if (!fs::is_regular_file(status)) throw FileError(name + ": not a regular file", name);
  const auto size = fs::file_size(file, error);
  if (error) throw FileError(name + ": cannot be read", name);
  checkSize(size, name);
  std::vector<std::byte> bytes(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) throw FileError(name + ": cannot be read", name);
  return bytes;
}

std::string_view textOf(std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

SoftMeshFile withElements(SoftMeshFile mesh, const std::string& name) {
  if (mesh.tets.empty() && mesh.triangles.empty())
    throw FileError(name + ": tetrahedra and triangles = 0: must be at least 1", name);
  return mesh;
}

}  // namespace

bool isSoftMeshFile(const fs::path& file) {
  const std::string extension = lowerCase(file.extension().string());
  if (extension != ".msh") return extension == ".vtk" || extension == ".node" || extension == ".ele";
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  std::string head(64, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  return soft_mesh_file::isGmsh(std::string_view(head).substr(0, static_cast<size_t>(in.gcount())));
}

SoftMeshFile readSoftMeshBytes(std::span<const std::byte> bytes, std::string_view kind,
                               std::string_view nameForMessages) {
  const std::string name(nameForMessages), asked = lowerCase(std::string(kind));
  if (asked != "msh" && asked != "vtk") throw FileError(name + ": kind = \"" + asked + "\": must be msh or vtk", name);
  checkSize(bytes.size(), name);
  const std::string_view text = textOf(bytes);
  if (asked == "vtk") return withElements(soft_mesh_file::readVtk(text, name), name);
  if (!soft_mesh_file::isGmsh(text)) throw FileError(name + ": must begin with $MeshFormat", name);
  return withElements(soft_mesh_file::readGmsh(text, name), name);
}

SoftMeshFile readTetgenBytes(std::span<const std::byte> node, std::span<const std::byte> ele,
                             std::string_view nameForMessages) {
  const std::string name(nameForMessages);
  checkSize(node.size(), name + ".node");
  checkSize(ele.size(), name + ".ele");
  return withElements(soft_mesh_file::readTetgen(textOf(node), textOf(ele), name), name + ".ele");
}

SoftMeshFile readSoftMeshFile(const fs::path& file) {
  const std::string extension = lowerCase(file.extension().string());
  if (extension == ".node" || extension == ".ele") {
    const fs::path stem = fs::path(file).replace_extension();
    // The one that was named keeps its name in any case.
    const auto of = [&](const char* kind) { return extension == kind ? file : fs::path(stem.string() + kind); };
    return readTetgenBytes(bytesOf(of(".node")), bytesOf(of(".ele")), stem.string());
  }
  if (extension != ".msh" && extension != ".vtk")
    throw FileError(file.string() + ": extension = \"" + extension + "\": must be .msh, .vtk, .node or .ele",
                    file.string());
  return readSoftMeshBytes(bytesOf(file), extension.substr(1), file.string());
}

std::shared_ptr<const SoftMeshData> makeSoftMesh(const SoftMeshFile& mesh, std::string_view nameForMessages) {
  const std::string name(nameForMessages);
  try {
    if (!mesh.tets.empty()) return makeTetMesh({mesh.points, mesh.tets});
    return makeClothMesh({mesh.points, mesh.triangles});
  } catch (const Error& error) {
    throw FileError(name + ": " + error.what(), name);
  }
}

}  // namespace avbd
