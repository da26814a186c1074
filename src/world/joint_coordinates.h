// Where the coordinates of hinges, sliders and D6 joints are (avbd/rows/d6_joint.h). In double; nothing here feeds
// back.
#pragma once

#include "world/world_data.h"

namespace avbd {

/// By inner axis (D6Data).
struct JointMotion {
  double position[6] = {}, velocity[6] = {};  ///< the twist with full turns
};
JointMotion motionOf(const WorldData& data, uint32_t joint);

/// The length of a distance joint or pulley, or L of a coupling, and its rate.
struct LinkMotion {
  double position = 0, velocity = 0;
};
LinkMotion linkMotionOf(const WorldData& data, uint32_t joint);
LinkMotion couplingMotion(const WorldData& data, const LinkData& link);
/// A body as a user's family sees it; of kNone the world.
CustomBody customBodyOf(const WorldData& data, uint32_t body);
/// How far a distance joint, pulley or locked coupling is from holding.
double linkGap(const WorldData& data, uint32_t joint);
/// The largest |C| of a custom joint's hard rows.
double customGap(const WorldData& data, uint32_t joint);

/// Distance along locked axes.
double lockedGap(const WorldData& data, uint32_t joint);
/// Angle about locked axes.
double lockedAngle(const WorldData& data, uint32_t joint);

/// Inner axis of a user's one.
inline size_t innerAxis(const D6Data& d6, JointAxis axis) {
  const size_t i = static_cast<size_t>(axis), group = i / 3 * 3;
  return group + (i - group + 3 - d6.turned) % 3;
}

}  // namespace avbd
