// Mesh files: opening, and which kind it is.
#include "io/mesh_file.h"

#include <algorithm>
#include <fstream>

#include "io/mesh_file_parts.h"
#include "io/soft_mesh_file_parts.h"

namespace avbd {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxBytes = size_t{64} << 20;

void refuseLarge(uint64_t size, const std::string& name) {
  if (size > kMaxBytes) {
    throw FileError(name + ": size = " + std::to_string(size) + ": must be at most " + std::to_string(kMaxBytes) +
                        " bytes (64 MiB)",
                    name);
  }
}

std::string lowerCase(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  return text;
}

MeshFile readBytes(std::span<const std::byte> bytes, std::string_view kind, const std::string& name) {
  const std::string asked = lowerCase(std::string(kind));
  refuseLarge(bytes.size(), name);
  if (asked != "obj" && asked != "stl" && asked != "msh") {
    throw FileError(name + ": kind = \"" + asked + "\": must be obj, stl or msh", name);
  }
  if (bytes.empty()) throw FileError(name + ": the file is empty", name);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (asked == "obj") {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
      throw FileError(name + ": text in UTF-16: must be UTF-8 or ASCII", name);
    }
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  }
  if (asked == "msh" && soft_mesh_file::isGmsh(text))
    throw FileError(name + ": is a Gmsh mesh, a soft body's: must be MuJoCo's MSH", name);
  const bool lies = asked != "stl" && !(asked == "msh" && mesh_file::isMsh(text)) && mesh_file::isStl(text);
  MeshFile out = lies || asked == "stl" ? mesh_file::readStl(text, name)
                 : asked == "obj"       ? mesh_file::readObj(text, name)
                                        : mesh_file::readMsh(text, name);
  if (lies) out.notes.push_back(name + ": is STL, not what its name says");
  return out;
}

MeshFile withTriangles(MeshFile mesh, const std::string& name) {
  if (mesh.triangles.empty()) throw FileError(name + ": triangles = 0: must be at least 1", name);
  return mesh;
}

}  // namespace

namespace mesh_file {

MeshFile readFile(const fs::path& file) {
  const std::string name = file.string();
  std::error_code error;
  // Devices and pipes could go on for ever.
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw FileError(name + ": no such file", name);
  if (!fs::is_regular_file(status)) throw FileError(name + ": not a regular file", name);
  const std::string extension = lowerCase(file.extension().string());
  if (extension != ".obj" && extension != ".stl" && extension != ".msh") {
    throw FileError(name + ": extension = \"" + extension + "\": must be .obj, .stl or .msh", name);
  }
  const auto size = fs::file_size(file, error);
  if (error) throw FileError(name + ": cannot be read", name);
  refuseLarge(size, name);
  std::vector<std::byte> bytes(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) throw FileError(name + ": cannot be read", name);
  return readBytes(bytes, extension.substr(1), name);
}

}  // namespace mesh_file

MeshFile readMeshBytes(std::span<const std::byte> bytes, std::string_view kind, std::string_view nameForMessages) {
  const std::string name(nameForMessages);
  return withTriangles(readBytes(bytes, kind, name), name);
}

MeshFile readMeshFile(const fs::path& file) { return withTriangles(mesh_file::readFile(file), file.string()); }

}  // namespace avbd
