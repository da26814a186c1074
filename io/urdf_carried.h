// What a drive of a URDF joint has to move: from this its stiffness follows.
#pragma once

#include "io/urdf_groups.h"

namespace avbd::urdf {

/// All other joints are taken as stiff. Of two sides that both move the heavier counts: the lighter, such as a foot,
/// may come to stand on the ground and have to carry the rest.
class Carried {
 public:
  Carried(const Description& description, const Groups& groups, const std::vector<Posed>& poses);

  /// [kg] along a line. 0 where nothing moves.
  double along(size_t joint) const;
  /// [kg m^2] about the line through the joint with this unit direction in the world.
  double about(size_t joint, Vec3d direction) const;

 private:
  template <class Measure>
  double felt(size_t joint, const Measure& measure) const;

  const Description& in_;
  const Groups& groups_;
  const std::vector<Posed>& poses_;
  std::vector<Mass> below_;       // by first link: its body and all that joints hang on it, but for what rests; world
  std::vector<char> restsBelow_;  // by first link: the body that rests is among them
  std::vector<size_t> top_;       // by first link: the uppermost body that joints join it to
};

}  // namespace avbd::urdf
