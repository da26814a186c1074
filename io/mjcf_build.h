// From an MJCF description to a Model: which bodies become one, then bodies, shapes, joints and filters.
#pragma once

#include <map>

#include "io/mjcf.h"
#include "io/mjcf_parse.h"
#include "io/notes.h"

namespace avbd::mjcf {

/// What becomes of each body of a description.
struct Clusters {
  enum class Link : uint8_t { Static, Mocap, Free, Ball };
  std::vector<int> rootOf;   ///< by body: the body whose frame it is part of; its own index for a root
  std::vector<Link> linkOf;  ///< by body, meaningful for roots
};
/// Bodies without a joint of ours are part of their parent.
Clusters clustersOf(const Description& description);
/// One ball joint and nothing else.
bool isBallOnly(const Body& body);

/// Index into description.keys, or -1 for the file's own poses. Throws FileError for a name that is not there.
int chosenKey(const Description& description, const MjcfOptions& options);
std::string keyName(const Description& description, size_t key);

/// What contact pairs make of a geom that the filters alone would not let collide.
struct PairGroup {
  int group = 0;         ///< positive
  double friction = -1;  ///< replaces the geom's own; -1 keeps it
};
/// By body and geom. Pairs that cannot be expressed are noted.
std::map<std::pair<int, size_t>, PairGroup> pairGroups(const Description& description, Notes& notes);

Model buildModel(const Description& description, const MjcfOptions& options);

}  // namespace avbd::mjcf
