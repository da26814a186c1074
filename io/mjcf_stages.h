// The joints of one MJCF body as joints of ours.
//
// MJCF lets a body have several joints, one moving after the other. What one of our joints does exactly is one stage:
// slides along axes at right angles, then nothing, a ball, a hinge along or across the slides, or two hinges at right
// angles whose axes meet. Two hinges R(u1, q1) R(u2, q2) are a swing about u1 and a twist about u2; a swing ends at
// half a turn, so the hinge that swings must have limits below that. It is the first, or seen from the child (turned)
// the second. Between two stages stands a light body of ours. It gets its mass from the child, at the next stage's
// anchor: there a point mass moves with either of the two, so that nothing changes. What its inertia is off by, about
// all axes alike, is small beside the child's least moment.
#pragma once

#include <avbd/joint.h>

#include <vector>

#include "io/mjcf_parse.h"

namespace avbd::mjcf {

struct Stage {
  size_t first = 0, count = 0;  ///< of the body's joints
  Posed frame;                  ///< in the body's frame at the joints' references: both sides' frame there
  bool turned = false;          ///< side A is the child
  /// Of its joints: the coordinate, and its sign against the file's. Twist for a ball.
  std::vector<JointAxis> axes;
  std::vector<double> signs;
};

/// Of a body without a free joint; empty for one without joints.
std::vector<Stage> stagesOf(const Body& body);

/// What the body before the stage at `anchor` takes from the child's mass; all in the child's frame.
Mass splitOff(Mass& child, Vec3d anchor);

}  // namespace avbd::mjcf
