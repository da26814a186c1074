// Where the mesh that a URDF file names lies on the disk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/urdf.h"
#include "io/urdf_parse.h"

namespace avbd::urdf {

struct FoundMesh {
  enum class Outcome {
    Found,
    Missing,
    UnknownKind,  ///< the file is there, but neither it nor a sibling can be read
    Elsewhere,    ///< a scheme that names no file, such as http
  };
  Outcome outcome = Outcome::Missing;
  std::filesystem::path file;
  std::string note;                ///< how it differs from what was asked for; empty: not at all
  std::vector<std::string> tried;  ///< where Missing
};

class MeshFiles {
 public:
  MeshFiles(const Description& description, const UrdfOptions& options);

  /// Throws FileError for a package path that leaves its package. A link may leave it for a folder of UrdfOptions, or
  /// for another folder that package.xml calls the same package.
  FoundMesh find(const Shape& shape) const;

 private:
  struct Place {
    std::filesystem::path file;
    std::filesystem::path package;  ///< that `file` must not leave; empty: any place will do
    std::string packageName;
  };
  std::vector<Place> places(const Shape& shape, const std::string& uri) const;
  std::vector<std::filesystem::path> packageFolders(const std::string& package) const;
  void refuseLinkOut(const Shape& shape, const std::filesystem::path& file, const Place& place) const;
  [[noreturn]] void refuseEscape(const Shape& shape, const std::string& how) const;

  const Description& description_;
  const UrdfOptions& options_;
  std::filesystem::path folder_;  // absolute
};

/// That a collision cannot be had from its mesh: with place and name.
[[noreturn]] void failMesh(const Description& description, const Shape& shape, const std::string& message);

}  // namespace avbd::urdf
