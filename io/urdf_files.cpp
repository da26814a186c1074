// Where the mesh that a URDF file names lies on the disk.
#include "io/urdf_files.h"

#include <algorithm>
#include <pugixml.hpp>

#include "io/xml_source.h"

namespace avbd::urdf {

namespace fs = std::filesystem;

namespace {

constexpr const char* kReadable[] = {".stl", ".obj", ".msh"};

std::string lower(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}
bool isFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}
bool isReadable(const fs::path& path) {
  const std::string kind = lower(path.extension().string());
  return std::find(std::begin(kReadable), std::end(kReadable), kind) != std::end(kReadable);
}

// The only file of the folder whose name is this but for case; empty if there is none or more than one.
fs::path ignoringCase(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const std::string wanted = lower(name);
  fs::path found;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (lower(it->path().filename().string()) != wanted || !isFile(it->path())) continue;
    if (!found.empty()) return {};
    found = it->path();
  }
  return found;
}

// What package.xml calls the package that this folder is; empty where it is none.
std::string packageNameOf(const fs::path& folder) {
  constexpr uintmax_t kMostBytes = 1 << 20;
  const fs::path file = folder / "package.xml";
  std::error_code error;
  if (!isFile(file) || fs::file_size(file, error) > kMostBytes) return {};
  pugi::xml_document document;
  if (!document.load_file(file.c_str())) return {};
  return document.child("package").child("name").text().get();
}

bool isPackage(const fs::path& folder, const std::string& name) {
  return isFolder(folder) && (folder.filename() == name || packageNameOf(folder) == name);
}

constexpr int kMostLevels = 32;  // of folders above a file

// `file` as the disk has it, without links.
bool isInside(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path outer = fs::weakly_canonical(folder.has_filename() ? folder : folder.parent_path(), error);
  return std::mismatch(outer.begin(), outer.end(), file.begin(), file.end()).first == outer.end();
}

// Whether a folder above `file` is this package by its package.xml.
bool isInPackage(const fs::path& file, const std::string& name) {
  fs::path at = file.parent_path();
  for (int level = 0; level < kMostLevels && at.has_relative_path(); ++level, at = at.parent_path()) {
    if (packageNameOf(at) == name) return true;
  }
  return false;
}

}  // namespace

void failMesh(const Description& description, const Shape& shape, const std::string& message) {
  throw FileError(shape.where + " > mesh: filename = " + mjcf::quoted(shape.mesh) + ": " + message,
                  description.fileName, shape.line);
}

MeshFiles::MeshFiles(const Description& description, const UrdfOptions& options)
    : description_(description), options_(options) {
  std::error_code error;
  folder_ = fs::absolute(description.folder.empty() ? fs::path(".") : description.folder, error).lexically_normal();
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
}

void MeshFiles::refuseEscape(const Shape& shape, const std::string& how) const {
  failMesh(description_, shape, how + ": a package path must stay in the folder of its package");
}

// A link may lead to where the user himself sent us, or to the package's own sources: that is what installing by links
// makes (colcon build --symlink-install).
void MeshFiles::refuseLinkOut(const Shape& shape, const fs::path& file, const Place& place) const {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(file, error);
  bool allowed = place.package.empty() || isInside(target, place.package) || isInPackage(target, place.packageName);
  for (const auto& [name, folder] : options_.packages) allowed = allowed || isInside(target, folder);
  for (const fs::path& folder : options_.packagePaths) allowed = allowed || isInside(target, folder);
  if (allowed) return;
  refuseEscape(shape, "leaves by a symbolic link to " + target.string() + ", where no --package DIR leads");
}

std::vector<fs::path> MeshFiles::packageFolders(const std::string& package) const {
  std::vector<fs::path> out;
  const auto named = options_.packages.find(package);
  if (named != options_.packages.end()) return {named->second};
  const auto look = [&](const fs::path& folder) {
    if (isPackage(folder, package)) out.push_back(folder);
    if (isFolder(folder / package)) out.push_back(folder / package);
  };
  for (const fs::path& folder : options_.packagePaths) {
    // A path that ends in a slash has no file name.
    look(folder.has_filename() ? folder : folder.parent_path());
    // A package's folder may have another name than the package.
    std::error_code error;
    std::vector<fs::path> inside;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (it->path().filename() != package && packageNameOf(it->path()) == package) inside.push_back(it->path());
    }
    std::sort(inside.begin(), inside.end());
    out.insert(out.end(), inside.begin(), inside.end());
  }
  fs::path at = folder_;
  for (int level = 0; level < kMostLevels; ++level) {
    look(at);
    if (!at.has_relative_path()) break;
    at = at.parent_path();
  }
  return out;
}

std::vector<MeshFiles::Place> MeshFiles::places(const Shape& shape, const std::string& uri) const {
  const size_t scheme = uri.find("://");
  const std::string rest = scheme == std::string::npos ? uri : uri.substr(scheme + 3);
  const std::string kind = scheme == std::string::npos ? "" : lower(uri.substr(0, scheme));
  if (kind.empty() || kind == "file") {
    const fs::path path(rest);
    return {{path.is_absolute() ? path : folder_ / path, {}, {}}};
  }
  const size_t slash = rest.find('/');
  const std::string package = rest.substr(0, slash);
  if (package.empty()) refuseEscape(shape, "an absolute path");
  if (slash == std::string::npos) failMesh(description_, shape, "must be " + kind + "://NAME/FILE");
  if (package == "." || package == "..") refuseEscape(shape, "package " + mjcf::quoted(package));
  // package://NAME//FILE is common and means the same as with one slash.
  const size_t start = std::min(rest.find_first_not_of('/', slash), rest.size());
  const fs::path normal = fs::path(rest.substr(start)).lexically_normal();
  if (!normal.empty() && *normal.begin() == "..") refuseEscape(shape, "leaves by \"..\"");
  std::vector<Place> out;
  for (const fs::path& folder : packageFolders(package)) out.push_back({folder / normal, folder, package});
  return out;
}

FoundMesh MeshFiles::find(const Shape& shape) const {
  FoundMesh out;
  std::string uri = shape.mesh;
  if (uri.find('\\') != std::string::npos) {
    std::replace(uri.begin(), uri.end(), '\\', '/');
    out.note = "backslashes taken for slashes";
  }
  const auto put = [&](const fs::path& file, const Place& place, const std::string& note) {
    refuseLinkOut(shape, file, place);
    out.outcome = FoundMesh::Outcome::Found;
    out.file = file;
    if (!note.empty()) out.note += (out.note.empty() ? "" : "; ") + note;
  };
  const size_t scheme = uri.find("://");
  if (scheme != std::string::npos) {
    const std::string kind = lower(uri.substr(0, scheme));
    if (kind != "package" && kind != "model" && kind != "file") {
      out.outcome = FoundMesh::Outcome::Elsewhere;
      return out;
    }
  }
  for (const Place& place : places(shape, uri)) {
    const fs::path folder = place.file.parent_path();
    const std::string name = place.file.filename().string(), stem = place.file.stem().string();
    fs::path file = isFile(place.file) ? place.file : ignoringCase(folder, name);
    if (!file.empty() && isReadable(file)) {
      const std::string found = file.filename().string();
      put(file, place, found == name ? "" : "found as " + mjcf::quoted(found));
      return out;
    }
    for (const char* kind :
         isReadable(name) ? std::vector<const char*>{} : std::vector<const char*>{".stl", ".obj", ".msh"}) {
      const fs::path sibling =
          isFile(folder / (stem + kind)) ? folder / (stem + kind) : ignoringCase(folder, stem + kind);
      if (sibling.empty()) continue;
      put(sibling, place, mjcf::quoted(sibling.filename().string()) + " beside it is read instead");
      return out;
    }
    if (!file.empty()) {
      out.outcome = FoundMesh::Outcome::UnknownKind;
      return out;
    }
    out.tried.push_back(place.file.string());
  }
  return out;
}

}  // namespace avbd::urdf
