// Convex hulls of the meshes that a URDF file names.
#include "io/urdf_hulls.h"

#include <avbd/decompose.h>

#include "io/hull_cache.h"
#include "io/xml_source.h"

namespace avbd::urdf {

void Hulls::fault(const Shape& shape, const std::string& message) {
  if (options_.badMesh == BadMesh::Refuse) {
    failMesh(description_, shape, message + " (--skip-bad-meshes leaves it out)");
  }
  notes_.add(shape.where, "mesh " + mjcf::quoted(shape.mesh) + ": " + message + ": left out");
}

MeshHulls Hulls::get(const Shape& shape) {
  using Outcome = FoundMesh::Outcome;
  const FoundMesh found = files_.find(shape);
  const std::string mesh = "mesh " + mjcf::quoted(shape.mesh);
  if (!found.note.empty()) notes_.add(shape.where, mesh + ": " + found.note);
  switch (found.outcome) {
    case Outcome::Found:
      break;
    case Outcome::UnknownKind:
      notes_.add(shape.where, mesh + ": only .stl, .obj and .msh are read, and none stands beside it: left out");
      return {};
    case Outcome::Elsewhere:
      fault(shape, "must be package://, model://, file:// or a path");
      return {};
    case Outcome::Missing: {
      std::string message = "no such file";
      for (size_t i = 0; i < found.tried.size() && i < 8; ++i) message += (i == 0 ? "; tried " : ", ") + found.tried[i];
      if (found.tried.empty()) message += "; no folder of this package was found (--package NAME=DIR names it)";
      fault(shape, message);
      return {};
    }
  }
  const Key key{found.file.string(), shape.scale.x, shape.scale.y, shape.scale.z};
  const auto known = made_.find(key);
  if (known != made_.end()) return known->second;
  return made_.emplace(key, make(shape, found.file)).first->second;
}

MeshHulls Hulls::make(const Shape& shape, const std::filesystem::path& file) {
  try {
    const MeshFile mesh = readMeshFile(file);
    for (const std::string& line : mesh.notes) notes_.add(shape.where, line);
    // Scaled here and not by Hull::scale, whose range is meant for other things than millimetres.
    std::vector<Vec3> points;
    points.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) {
      const Vec3d p{v.x * shape.scale.x, v.y * shape.scale.y, v.z * shape.scale.z};
      // Beyond what a hull may have, and a float perhaps cannot: refused below.
      constexpr double kMost = 1e7;
      const auto narrow = [](double x) { return static_cast<float>(x < -kMost ? -kMost : x > kMost ? kMost : x); };
      points.push_back({narrow(p.x), narrow(p.y), narrow(p.z)});
    }
    if (options_.decompose) return decomposed(shape, points, mesh);
    return {makeHull({.points = points})};
  } catch (const FileError& error) {
    fault(shape, error.what());
  } catch (const Error& error) {
    fault(shape, std::string(options_.decompose ? "its hulls: " : "its hull: ") + error.what());
  }
  return {};
}

MeshHulls Hulls::decomposed(const Shape& shape, std::span<const Vec3> points, const MeshFile& mesh) {
  std::vector<std::array<uint32_t, 3>> triangles = mesh.triangles;
  // A mirrored mesh is inside out.
  if (shape.scale.x * shape.scale.y * shape.scale.z < 0) {
    for (auto& t : triangles) std::swap(t[1], t[2]);
  }
  const DecomposeDef def{.vertices = points, .triangles = triangles, .seal = true};
  CachedDecomposition made;
  if (options_.hullCache.empty()) {
    made.result = decompose(def);
  } else {
    made = decomposeCached(def, options_.hullCache);
  }
  if (!made.note.empty()) notes_.add(shape.where, "mesh " + mjcf::quoted(shape.mesh) + ": hull cache: " + made.note);
  Decomposition& parts = made.result;
  if (parts.openEdges > 0) {
    notes_.add(shape.where, "mesh " + mjcf::quoted(shape.mesh) + ": not closed (" + std::to_string(parts.openEdges) +
                                " open edges): sealed for its decomposition");
  }
  return std::move(parts.hulls);
}

}  // namespace avbd::urdf
