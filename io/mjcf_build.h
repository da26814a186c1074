// From an MJCF description to a Model: which bodies become one, then bodies, shapes, joints, what moves them, filters.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "io/mjcf.h"
#include "io/mjcf_parse.h"
#include "io/notes.h"

namespace avbd::mjcf {

/// What becomes of each body of a description.
struct Clusters {
  enum class Link : uint8_t { Static, Mocap, Free, Jointed, Particle };
  std::vector<int> rootOf;   ///< by body: the body whose frame it is part of; its own index for a root
  std::vector<Link> linkOf;  ///< by body, meaningful for roots
};
/// Bodies without a joint are part of their parent.
Clusters clustersOf(const Description& description);

/// Index into description.keys, or -1 for the file's own poses. Throws FileError for a name that is not there.
int chosenKey(const Description& description, const MjcfOptions& options);
std::string keyName(const Description& description, size_t key);

/// What contact pairs make of a geom that the filters alone would not let collide.
struct PairGroup {
  int group = 0;                      ///< positive
  double friction = -1;               ///< replaces the geom's own; -1 keeps it
  double torsional = 0, rolling = 0;  ///< replace the geom's own where friction does
};
/// By body and geom. Pairs that cannot be expressed are noted.
std::map<std::pair<int, size_t>, PairGroup> pairGroups(const Description& description, Notes& notes);

/// A geom as a shape of ours. Ours stand along y where MJCF's stand along z: `turn` is from ours to the geom's frame.
struct GeomShape {
  Geometry geometry;
  Quatd turn{};
};

/// Makes shapes of geoms; hulls and height fields once for all geoms that share them.
class GeomShapes {
 public:
  GeomShapes(const Description& description, Notes& notes);
  /// Nothing for geoms that are left out, with a note. Throws FileError.
  std::optional<GeomShape> shape(const Geom& geom);

 private:
  std::shared_ptr<const HullData> hull(const Geom& geom);
  std::shared_ptr<const HeightFieldData> heights(const Geom& geom);

  const Description& in_;
  Notes& notes_;
  std::vector<std::shared_ptr<const HullData>> hulls_;              // of in_.meshes
  std::vector<std::shared_ptr<const HeightFieldData>> heightData_;  // of in_.heights
};

/// A number as the world's float; refused where it is beyond it.
float narrow(double value, const std::string& where);

Model buildModel(const Description& description, const MjcfOptions& options);

}  // namespace avbd::mjcf
