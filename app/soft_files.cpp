// Soft bodies from files (soft_files.h).
#include "app/soft_files.h"

#include <algorithm>
#include <filesystem>

#include "app/failure.h"
#include "app/number_text.h"
#include "io/mesh_file.h"
#include "io/soft_mesh_file.h"
#include "scenes/build.h"

namespace avbd::cli {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

double volumeOf(const MeshFile& mesh) {
  double six = 0;
  const Vec3d from = toDouble(mesh.vertices[0]);
  for (const auto& t : mesh.triangles) {
    const auto at = [&](size_t i) { return toDouble(mesh.vertices[t[i]]) - from; };
    const Vec3d a = at(0), b = at(1), c = at(2);
    six += dot(a, Vec3d{b.y * c.z - b.z * c.y, b.z * c.x - b.x * c.z, b.x * c.y - b.y * c.x});
  }
  return six / 6;
}

SoftFile latticeOf(const std::string& file, double cell) {
  const MeshFile surface = readMeshFile(file);
  try {
    return {makeTetLattice(
                {.points = surface.vertices, .triangles = surface.triangles, .cellSize = static_cast<float>(cell)}),
            volumeOf(surface), surface.notes};
  } catch (const Error& error) {
    throw FileError(file + ": " + error.what(), file);
  }
}

std::string vectorText(Vec3d v) { return digits(v.x, 6) + ", " + digits(v.y, 6) + ", " + digits(v.z, 6); }

/// "none", or what was repaired.
std::string repairsText(const SoftMeshReport& r) {
  std::string text;
  const auto add = [&](uint32_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(r.inverted, "inverted were turned");
  add(r.degenerate, "without size left out");
  add(r.duplicate, "twice there left out once");
  add(r.unused, "points of none left out");
  return text.empty() ? "none" : text;
}

}  // namespace

SoftFile readSoft(const std::string& file, std::optional<double> cell) {
  if (cell && scenes::find(file))
    throw BadInput("--soft " + digits(*cell, 9) + ": " + file + " is a scene, not a surface");
  if (!isSoftMeshFile(file)) return latticeOf(file, cell.value());
  if (cell) throw BadInput("--soft " + digits(*cell, 9) + ": " + file + " is a soft mesh already, not a surface");
  SoftMeshFile mesh = readSoftMeshFile(file);
  return {makeSoftMesh(mesh, file), {}, std::move(mesh.notes)};
}

SoftMeshInfo infoOf(const SoftFile& soft, const std::string& name) {
  const SoftMeshData& mesh = *soft.mesh;
  SoftMeshInfo info;
  info.name = name;
  info.report = mesh.report();
  info.points = mesh.points().size();
  info.tets = mesh.tets().size();
  info.triangles = mesh.triangles().size();
  info.surface = mesh.surface().size();
  info.lower = info.upper = toDouble(mesh.points()[0]);
  for (const Vec3 p : mesh.points())
    for (double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
      info.lower.*axis = std::min(info.lower.*axis, toDouble(p).*axis);
      info.upper.*axis = std::max(info.upper.*axis, toDouble(p).*axis);
    }
  info.volume = mesh.volume();
  info.area = mesh.area();
  info.quality = qualityOf(mesh);
  info.surfaceVolume = soft.surfaceVolume;
  info.notes = soft.notes;
  return info;
}

ReportLines reportLines(const SoftMeshInfo& info) {
  const SoftMeshQuality& q = info.quality;
  ReportLines lines{{"soft mesh", info.name}, {"points", std::to_string(info.points)}};
  if (info.tets > 0)
    lines.emplace_back("tetrahedra",
                       std::to_string(info.tets) + ", outside of " + std::to_string(info.surface) + " triangles");
  else
    lines.emplace_back("triangles", std::to_string(info.triangles) + " of cloth");
  lines.emplace_back("repaired", repairsText(info.report));
  lines.emplace_back("pieces", std::to_string(q.pieces));
  lines.emplace_back("bounds", vectorText(info.lower) + " to " + vectorText(info.upper) + " m");
  if (info.tets > 0) {
    lines.emplace_back("volume", digits(info.volume, 6) + " m^3");
    if (info.surfaceVolume)
      lines.emplace_back("of the surface", digits(100 * info.volume / *info.surfaceVolume, 5) + " % of its volume");
  }
  lines.emplace_back("area", digits(info.area, 6) + " m^2");
  lines.emplace_back("angles", digits(q.leastAngle / kDegree, 4) + " to " + digits(q.greatestAngle / kDegree, 4) +
                                   " degrees between " + (info.tets > 0 ? "faces" : "edges"));
  lines.emplace_back("radius ratio", digits(q.leastRadiusRatio, 4) + " at least, 1 is regular");
  lines.emplace_back("least height", digits(q.leastHeight, 4) + " m");
  for (const std::string& note : info.notes) lines.emplace_back("note", note);
  return lines;
}

Model dropped(const SoftFile& soft, const std::string& name, const SoftMaterial& material,
              const scenes::Settings& settings) {
  const SoftMeshInfo info = infoOf(soft, name);
  const float radius = std::min(0.01f, soft.mesh->faceSize() / 4);
  const Vec3d size = info.upper - info.lower;
  const double above = double{radius} + 0.25 * std::max({size.x, size.y, size.z});
  scenes::Build build(std::filesystem::path(name).filename().string(), settings);
  build.ground();
  build.soft(
      "soft",
      {.mesh = soft.mesh,
       .pose = {{-(info.lower.x + info.upper.x) / 2, above - info.lower.y, -(info.lower.z + info.upper.z) / 2}, {}},
       .material = material,
       .radius = radius});
  Model model = build.take();
  model.notes = soft.notes;
  return model;
}

}  // namespace avbd::cli
