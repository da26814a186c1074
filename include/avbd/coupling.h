// Couplings: one relation between coordinates of joints. Gears, racks, mimics and fixed tendons.
#pragma once

#include <avbd/joint.h>

#include <optional>
#include <vector>

namespace avbd {

/// What a coordinate q of a joint adds to a coupling: factor q + square q^2 + cube q^3 + fourth q^4.
struct CouplingTerm {
  JointId joint{};  ///< a hinge, slider or D6 joint
  JointAxis axis = JointAxis::Twist;
  float factor = 1, square = 0, cube = 0, fourth = 0;  ///< finite; not all zero
};

/// Makes the sum of its terms a coordinate of its own, L, and holds it at `rest` (axis.motion Locked) or leaves it free
/// with limit, drive, spring and friction. All bodies of the terms' joints feel its force. It goes with any of its
/// joints; while one of them is not enabled it does nothing.
struct Coupling {
  std::vector<CouplingTerm> terms;  ///< 1 .. 8
  std::optional<double> rest{};     ///< of a locked one: L; none takes what it is at creation
  D6Axis axis{};                    ///< of L; armature and maxVelocity are those of a free one
  float stiffness = 0;              ///< >= 0 of a locked one: [N m/rad] where L is an angle; 0: hard
  float damping = 0;                ///< >= 0 of a locked one with stiffness
  uint64_t userData = 0;
};

/// Two hinges turn against each other: ratio qA + qB stays what it is.
Coupling gear(JointId hingeA, JointId hingeB, float ratio);
/// A hinge (the pinion) drives a slider (the rack): x - radius q stays what it is.
Coupling rackAndPinion(JointId hinge, JointId slider, float radius);
/// q0 + ratio q1 + offset = 0, of the coordinates that hinges or sliders leave free; `axis` of each.
Coupling mimic(JointId joint0, JointId joint1, float ratio, float offset, JointAxis axis0 = JointAxis::Twist,
               JointAxis axis1 = JointAxis::Twist);

}  // namespace avbd
