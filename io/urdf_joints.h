// The joints of a URDF file in a world: hinges, sliders and their like, mimics as couplings, transmissions as
// actuators.
//
// Our coordinate of a hinge is its turn from where the frames agree, within half a turn at creation; a start beyond
// that is met by an offset of whole turns, which NamedJoint and Actuator tell.
#pragma once

#include "io/model.h"
#include "io/urdf_groups.h"

namespace avbd::urdf {

/// [Hz] Of the drives that hold a joint where it starts: critically damped, with all other joints stiff.
inline constexpr double kHoldFrequency = 20;

/// The bodies of a description in a model.
struct Placed {
  const Description& in;
  const Groups& groups;
  const std::vector<Posed>& poses;  ///< of links, in the world
  const std::vector<BodyId>& ids;   ///< by first link; null where no body was made
};

/// Adds joints, couplings and actuators to the model. `limp`: nothing holds the joints, and actuators are forces.
/// Throws FileError.
void addJoints(const Placed& placed, bool limp, Model& model, Notes& notes);

}  // namespace avbd::urdf
