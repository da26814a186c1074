// Acceleration drives of joints in trees: their stiffness and damping are times the inertia that they feel, which is
// that of the whole tree, so that what hangs on a joint does not change how it moves.
#include "step/begin_rows.h"
#include "step/coordinate_rows.h"

namespace avbd {

namespace {

using rows::Twist;

bool accelerates(const D6Data& data, const ScalarJoint& joint, int axis) {
  return (joint.axes.driven >> axis & 1) && data.axis[axis].drive.acceleration;
}

bool accelerates(const WorldData& world, const ScalarJoint& joint) {
  if (joint.kind != ScalarJoint::Kind::D6 || !joint.inTree) return false;
  const D6Data& data = world.d6[joint.slot];
  bool any = joint.axes.slerp && data.slerp.acceleration;
  for (int i = 0; i < 6; ++i) any = any || accelerates(data, joint, i);
  return any;
}

/// The inverse mass along the coordinates of a node's joint.
class Feel {
 public:
  Feel(const Forest& forest, const StepData& step, size_t node, const ScalarJoint& joint)
      : forest_(forest), step_(step), node_(node) {
    const Twist<float> still = rows::zeroTwist<float>();
    measure_ = joint.rows.measure(still, still);
  }
  float along(int axis) const {
    const Twist<float> wrench{measure_.lin[axis], measure_.ang[axis]};
    const Twist<float> onA = shiftWrench(wrench, measure_.armA), onB = -shiftWrench(wrench, measure_.armB);
    const bool childIsA = forest_.joints[static_cast<size_t>(forest_.nodes[node_].joint)].childIsA;
    return inverseMassOf(forest_, step_.response, node_, childIsA ? onA : onB, childIsA ? onB : onA) /
           (step_.h * step_.h);
  }

 private:
  const Forest& forest_;
  const StepData& step_;
  size_t node_;
  rows::D6Measure<float> measure_;
};

void weigh(const WorldData& world, const StepData& step, const Feel& feel, ScalarJoint& joint) {
  const D6Data& data = world.d6[joint.slot];
  for (int i = 0; i < 6; ++i) {
    if (!accelerates(data, joint, i)) continue;
    const float w = feel.along(i);
    if (!(w > 0)) continue;
    rows::D6Axis<float>& x = joint.rows.axis[i];
    x.kDrive = fillDriveOf(step, data.axis[i].drive, 1 / w + data.axis[i].armature, x);
  }
  if (!joint.axes.slerp || !data.slerp.acceleration) return;
  // One stiffness for all axes: that of the mean.
  const float w = (feel.along(3) + feel.along(4) + feel.along(5)) / 3;
  if (w > 0) joint.rows.slerp.k = (data.slerp.stiffness + data.slerp.damping / step.h) / w;
}

}  // namespace

void weighAccelerationDrives(const WorldData& world, StepData& step) {
  for (size_t batch = 0; batch < step.batches.size(); ++batch) {
    if (step.batches[batch].forest == kNone) continue;
    const BatchView view = step.view(batch);
    Forest& forest = step.forests[step.batches[batch].forest];
    bool found = false;
    for (size_t i = 0; i < forest.nodes.size(); ++i) {
      const int32_t at = forest.nodes[i].joint;
      if (at < 0 || forest.joints[static_cast<size_t>(at)].mixed < 0) continue;
      const MixedRows& mixed = forest.mixed[static_cast<size_t>(forest.joints[static_cast<size_t>(at)].mixed)];
      ScalarJoint& joint = view.scalar.joint[mixed.scalar];
      if (!accelerates(world, joint)) continue;
      if (!found) findResponses(view, forest, step.response);
      found = true;
      weigh(world, step, Feel(forest, step, i, joint), joint);
    }
  }
}

}  // namespace avbd
