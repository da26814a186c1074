// Which joints of a world make an articulation's tree, and in which order.
#pragma once

#include <avbd/articulation.h>

#include <span>
#include <vector>

namespace avbd::articulation {

struct Tree {
  std::vector<ArticulationLink> links;  ///< without their dofs
  std::vector<JointId> loopJoints;
  bool floating = false;
};

/// Throw Error.
Tree treeOf(const World& world, std::span<const JointId> joints);
Tree treeOf(const World& world, BodyId root);

}  // namespace avbd::articulation
