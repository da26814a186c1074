// Convex hulls of the meshes that a URDF file names.
#pragma once

#include <map>
#include <span>
#include <tuple>

#include "io/mesh_file.h"
#include "io/urdf_files.h"
#include "io/urdf_mass.h"

namespace avbd::urdf {

class Hulls {
 public:
  Hulls(const Description& description, const UrdfOptions& options, Notes& notes)
      : description_(description), options_(options), notes_(notes), files_(description, options) {}

  /// The hulls of a shape's mesh, scaled: one, or several where options.decompose asks; shared by shapes of equal mesh
  /// and scale. None where it was left out with a note. Throws FileError.
  MeshHulls get(const Shape& shape);

 private:
  using Key = std::tuple<std::string, double, double, double>;
  MeshHulls make(const Shape& shape, const std::filesystem::path& file);
  MeshHulls decomposed(const Shape& shape, std::span<const Vec3> points, const MeshFile& mesh);
  /// Refuses or notes, as options.badMesh says.
  void fault(const Shape& shape, const std::string& message);

  const Description& description_;
  const UrdfOptions& options_;
  Notes& notes_;
  MeshFiles files_;
  std::map<Key, MeshHulls> made_;
};

}  // namespace avbd::urdf
