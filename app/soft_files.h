// Soft bodies from files: of tetrahedra or triangles as they are, of a surface by the lattice that --soft asks for.
#pragma once

#include <optional>
#include <string>

#include "app/figures.h"
#include "scenes/scene.h"

namespace avbd::cli {

/// What `avbd info` says about one.
struct SoftMeshInfo {
  std::string name;
  SoftMeshReport report;
  size_t points = 0, tets = 0, triangles = 0, surface = 0;  ///< of what was made; surface: triangles of the outside
  Vec3d lower, upper;                                       ///< [m]
  double volume = 0, area = 0;                              ///< [m^3], [m^2]
  SoftMeshQuality quality;
  std::optional<double> surfaceVolume;  ///< [m^3] of the surface that a lattice was made of
  std::vector<std::string> notes;
};

struct SoftFile {
  std::shared_ptr<const SoftMeshData> mesh;
  std::optional<double> surfaceVolume;
  std::vector<std::string> notes;
};

/// cell: of the lattice [m]; set for a file that is no soft mesh. Throws BadInput for a cell where the name is not that
/// of a surface, and FileError.
SoftFile readSoft(const std::string& file, std::optional<double> cell);
SoftMeshInfo infoOf(const SoftFile& soft, const std::string& name);
ReportLines reportLines(const SoftMeshInfo& info);
/// The soft body above a ground.
Model dropped(const SoftFile& soft, const std::string& name, const SoftMaterial& material,
              const scenes::Settings& settings);

}  // namespace avbd::cli
