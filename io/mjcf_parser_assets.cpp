// MJCF meshes and height fields.
#include <avbd/avbd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "io/mesh_file_parts.h"
#include "io/mjcf_mesh.h"
#include "io/mjcf_parser.h"

namespace avbd::mjcf {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxAssetBytes = size_t{256} << 20;  // of all files of a model together
constexpr int kMostSide = 32768;                      // rows and columns of a height field
constexpr size_t kMany = size_t{1} << 28;

// A file's own message already says where; it lacks which element asked for it.
template <class Read>
auto forElement(const std::string& where, const Read& read) {
  try {
    return read();
  } catch (const FileError& error) {
    throw FileError(where + ": " + error.what(), error.file(), error.line());
  }
}

// MuJoCo's rule: the lowest is 0, the highest 1.
void normalize(std::vector<float>& heights) {
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double from = *low, range = double{*high} - from;
  for (float& h : heights) h = range > 0 ? static_cast<float>((h - from) / range) : 0;
}

}  // namespace

std::string Parser::assetName(const Attributes& a) const {
  std::string name = a.text("name");
  return name.empty() ? fs::path(a.text("file")).stem().string() : name;
}

// MuJoCo's rule: an absolute path as it is, all others from the model's folder and meshdir. `..` may leave the folder.
fs::path Parser::assetPath(const Attributes& a) {
  fs::path file(a.text("file"));
  if (compiler_.stripPath) file = file.filename();
  const std::optional<fs::path> folder = source_.folder();
  if (!folder) a.fail("file", "text that is not a file cannot read other files");
  const fs::path path = file.is_absolute() ? file : *folder / compiler_.meshFolder / file;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) a.fail("file", "no such file (" + path.string() + ")");
  // Devices and pipes could go on for ever.
  if (!fs::is_regular_file(status)) a.fail("file", "not a regular file (" + path.string() + ")");
  const auto size = fs::file_size(path, error);
  if (error) a.fail("file", "cannot be read (" + path.string() + ")");
  charge(a, "file", size);
  return path;
}

void Parser::charge(const Attributes& a, std::string_view attribute, uintmax_t bytes) {
  if (bytes > kMaxAssetBytes - assetBytes_) a.fail(attribute, "the model's meshes and height fields exceed 256 MiB");
  assetBytes_ += bytes;
}

void Parser::readMesh(Elem elem) {
  checkAttributes(source_, elem, "mesh", notes_);
  Attributes a = defaults_.resolve(elem, "mesh", Defaults::kMain);
  MeshAsset mesh;
  mesh.where = source_.where(elem);
  mesh.name = assetName(a);
  if (!a.has("file") && !a.has("vertex") && !a.has("builtin")) a.fail("file", "a mesh must have a file or vertex");
  if (a.has("file") && a.has("vertex")) a.fail("vertex", "not allowed beside file");
  if (mesh.name.empty()) a.fail("name", "a mesh without a file must have one");
  a.keyword("inertia", {"convex", "exact", "legacy", "shell"}, 2);
  mesh.mostVertices = a.integer("maxhullvert", -1);
  if (a.has("maxhullvert") && mesh.mostVertices != -1 && mesh.mostVertices < 4) {
    a.fail("maxhullvert", "must be -1, or 4 or more");
  }
  meshByName_.emplace(mesh.name, out_.meshes.size());
  out_.meshes.push_back(std::move(mesh));
  meshSources_.push_back({std::move(a)});
}

int Parser::meshNamed(const Attributes& a) {
  const auto it = meshByName_.find(a.requiredText("mesh"));
  if (it == meshByName_.end()) a.fail("mesh", "no mesh of this name in asset");
  const size_t index = it->second;
  MeshSource& from = meshSources_[index];
  if (!from.isRead) loadMesh(from.attributes, out_.meshes[index]);
  from.isRead = true;
  return static_cast<int>(index);
}

void Parser::loadMesh(const Attributes& a, MeshAsset& out) {
  if (a.has("builtin")) a.fail("builtin", "meshes that MuJoCo makes itself are not supported");
  if (a.has("vertex")) {
    inlineMesh(a, out);
  } else {
    const fs::path path = assetPath(a);
    const MeshFile file = forElement(out.where, [&] { return mesh_file::readFile(path); });
    for (const std::string& note : file.notes) notes_.add(out.where, note);
    for (const Vec3 v : file.vertices) out.vertices.push_back(toDouble(v));
    out.triangles = file.triangles;
  }
  placeMesh(a, out);
  weighMesh(a, out);
}

void Parser::inlineMesh(const Attributes& a, MeshAsset& out) {
  const std::vector<double> numbers = a.numbers("vertex", 0, kMany);
  if (numbers.size() % 3 != 0 || numbers.size() < 12)
    a.fail("vertex", "must be 3 numbers for each of 4 or more vertices");
  charge(a, "vertex", numbers.size() / 3 * sizeof(Vec3d));
  for (size_t i = 0; i < numbers.size(); i += 3) out.vertices.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  const std::vector<double> faces = a.numbers("face", 0, kMany);
  if (faces.size() % 3 != 0) a.fail("face", "must be 3 numbers for each triangle");
  charge(a, "face", faces.size() * sizeof(uint32_t));
  for (size_t i = 0; i < faces.size(); i += 3) {
    std::array<uint32_t, 3> triangle;
    for (size_t k = 0; k < 3; ++k) {
      const double index = faces[i + k];
      if (!(index >= 0 && index < static_cast<double>(out.vertices.size()) && index == std::floor(index))) {
        a.fail("face", "each must be a whole number 0 .. " + std::to_string(out.vertices.size() - 1));
      }
      triangle[k] = static_cast<uint32_t>(index);
    }
    out.triangles.push_back(triangle);
  }
}

void Parser::placeMesh(const Attributes& a, MeshAsset& out) const {
  const Vec3d position = vector(a, "refpos", {}), scale = vector(a, "scale", {1, 1, 1});
  if (scale.x == 0 || scale.y == 0 || scale.z == 0) a.fail("scale", "each must not be 0");
  Quatd turn;
  if (const auto v = a.numbers("refquat", 4, 4); !v.empty()) {
    turn = {v[0], v[1], v[2], v[3]};
    if (!(turn.w * turn.w + turn.x * turn.x + turn.y * turn.y + turn.z * turn.z > 1e-14)) {
      a.fail("refquat", "must not be zero");
    }
    turn = conjugate(normalized(turn));
  }
  for (Vec3d& v : out.vertices) {
    v = rotate(turn, v - position);
    v = {v.x * scale.x, v.y * scale.y, v.z * scale.z};
    if (!(std::abs(v.x) <= 1e6 && std::abs(v.y) <= 1e6 && std::abs(v.z) <= 1e6)) {
      throw FileError(out.where + ": vertex = " + std::to_string(v.x) + " " + std::to_string(v.y) + " " +
                          std::to_string(v.z) + ": each must be at most 1e6 in magnitude",
                      out_.fileName);
    }
  }
  // A mirror turns the triangles inside out.
  if (scale.x * scale.y * scale.z < 0) {
    for (auto& t : out.triangles) std::swap(t[1], t[2]);
  }
}

void Parser::weighMesh(const Attributes& a, MeshAsset& out) {
  if (out.triangles.empty()) {
    // Points alone stand for their hull.
    std::vector<Vec3> points;
    Vec3d low = out.vertices.empty() ? Vec3d{} : out.vertices[0], high = low;
    for (const Vec3d& v : out.vertices) {
      points.push_back(toFloat(v));
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    try {
      const float tolerance = static_cast<float>(1e-6 * length(high - low));
      const auto hull = makeHull({.points = points, .tolerance = tolerance, .maxVertices = 255});
      out.vertices.clear();
      for (const Vec3 v : hull->vertices()) out.vertices.push_back(toDouble(v));
      for (const HullData::Face& face : hull->faces()) {
        const auto loop = hull->loops().subspan(face.first, face.count);
        for (size_t i = 2; i < loop.size(); ++i) out.triangles.push_back({loop[0], loop[i - 1], loop[i]});
      }
    } catch (const Error& error) {
      throw FileError(out.where + ": a mesh without faces: " + error.what(), out_.fileName);
    }
  }
  const int rule = a.keyword("inertia", {"convex", "exact", "legacy", "shell"}, compiler_.exactMeshInertia ? 1 : 2);
  if (rule == 0) notes_.add(out.where, "inertia of the hull is asked for: that of the mesh is used");
  out.shell = shellMass(out);
  out.solid = rule == 3 ? out.shell : solidMass(out, rule == 1);
}

// What has only a texture has no colour of its own.
void Parser::readMaterial(Elem elem) {
  checkAttributes(source_, elem, "material", notes_);
  const Attributes a = defaults_.resolve(elem, "material", Defaults::kMain);
  std::optional<Color>& color = materials_[a.text("name")];
  const std::vector<double> rgba = a.numbers("rgba", 4, 4);
  if (!rgba.empty()) {
    color = colorOf(rgba[0], rgba[1], rgba[2], rgba[3]);
  } else if (!a.has("texture")) {
    color = colorOf(1, 1, 1, 1);
  }
}

void Parser::readHeights(Elem elem) {
  const Attributes a = own(elem, "hfield");
  HeightAsset out;
  out.where = source_.where(elem);
  out.name = assetName(a);
  const std::vector<double> size = a.numbers("size", 4, 4);
  if (size.empty()) a.fail("size", "must be 4 numbers: radius_x radius_y elevation_z base_z");
  for (const double s : size) {
    if (!(s > 0)) a.fail("size", "each must be finite and > 0");
  }
  out.radius = {size[0], size[1], size[2]};
  out.base = size[3];
  if (a.has("file")) {
    heightsFromFile(a, out);
  } else {
    heightsFromText(a, out);
  }
  heightsByName_.emplace(out.name, out_.heights.size());
  out_.heights.push_back(std::move(out));
}

void Parser::heightsFromText(const Attributes& a, HeightAsset& out) {
  const auto side = [&](std::string_view name) {
    const int count = a.integer(name, 0);
    if (count < 2 || count > kMostSide) a.fail(name, "must be 2 .. " + std::to_string(kMostSide));
    return count;
  };
  out.rows = side("nrow");
  out.columns = side("ncol");
  const size_t rows = static_cast<size_t>(out.rows), columns = static_cast<size_t>(out.columns);
  charge(a, "nrow", rows * columns * sizeof(float));
  out.heights.assign(rows * columns, 0);
  if (!a.has("elevation")) return;  // flat, for a program to fill
  const std::vector<double> values = a.numbers("elevation", 0, kMany);
  if (values.size() != rows * columns) {
    a.fail("elevation", "holds " + std::to_string(values.size()) +
                            " numbers: must be nrow * ncol = " + std::to_string(rows * columns));
  }
  // The text is written as seen from above, its first row farthest along y.
  for (size_t r = 0; r < rows; ++r) {
    for (size_t c = 0; c < columns; ++c) {
      out.heights[(rows - 1 - r) * columns + c] = static_cast<float>(values[r * columns + c]);
    }
  }
  normalize(out.heights);
}

void Parser::heightsFromFile(const Attributes& a, HeightAsset& out) {
  for (const char* name : {"nrow", "ncol"}) {
    if (a.integer(name, 0) != 0) a.fail(name, "not allowed beside file");
  }
  const fs::path path = assetPath(a);
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return static_cast<char>(c | 0x20); });
  if (extension == ".png" || a.text("content_type") == "image/png") {
    notes_.add(out.where, "height fields from PNG are not read: geoms that use it are left out");
    return;
  }
  std::string bytes(fs::file_size(path), '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const auto fail = [&](size_t at, const std::string& message) {
    throw FileError(out.where + ": " + path.string() + ": byte " + std::to_string(at) + ": " + message, path.string());
  };
  if (!in) fail(0, "cannot be read");
  if (bytes.size() < 8) fail(bytes.size(), "size = " + std::to_string(bytes.size()) + ": the head must have 8 bytes");
  const uint64_t rows = mesh_file::word(bytes, 0), columns = mesh_file::word(bytes, 4);
  if (rows < 2 || rows > kMostSide) fail(0, "rows = " + std::to_string(rows) + ": must be 2 .. 32768");
  if (columns < 2 || columns > kMostSide) fail(4, "columns = " + std::to_string(columns) + ": must be 2 .. 32768");
  if (8 + 4 * rows * columns != bytes.size()) {
    fail(8, "size = " + std::to_string(bytes.size()) + ": must be " + std::to_string(8 + 4 * rows * columns) +
                " bytes, as its rows and columns need");
  }
  out.rows = static_cast<int>(rows);
  out.columns = static_cast<int>(columns);
  for (size_t i = 0; i < rows * columns; ++i) {
    out.heights.push_back(mesh_file::real(bytes, 8 + 4 * i));
    if (!std::isfinite(out.heights.back())) {
      fail(8 + 4 * i, "height " + std::to_string(i) + " = " + std::to_string(out.heights.back()) + ": must be finite");
    }
  }
  normalize(out.heights);
}

}  // namespace avbd::mjcf
