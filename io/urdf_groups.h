// Which links of a URDF file become one body, and what each body weighs.
#pragma once

#include "io/urdf_mass.h"

namespace avbd::urdf {

struct Groups {
  std::vector<size_t> bodyOf;   ///< by link: the first link of its body
  std::vector<Mass> masses;     ///< by first link, in its frame; a mass of 0: none
  std::vector<char> hasShapes;  ///< by first link
  std::vector<char> welded;     ///< by joint: its links are one body
  int still = -1;               ///< first link of the body that does not move; -1: all move
};

/// Links are one body where fixed joints join them, where nothing of mass or shape hangs on a joint, and where a joint
/// follows one that is welded. A link without mass between joints gets a little. `poses`: of links, in the world.
Groups groupsOf(const Description& description, const std::vector<Posed>& poses, const std::vector<LinkHulls>& hulls,
                bool floating, Notes& notes);

/// The frame of a link in its body's.
Posed inBody(const Groups& groups, const std::vector<Posed>& poses, size_t link);

/// Whether forces pass this joint: all but floating ones.
inline bool joins(const Joint& joint) { return joint.kind != JointKind::Floating; }

}  // namespace avbd::urdf
