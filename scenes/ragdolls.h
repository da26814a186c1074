// A ragdoll of 16 bodies.
#pragma once

#include <array>

#include "scenes/build.h"

namespace avbd::scenes {

inline constexpr size_t kRagdollBodies = 16, kRagdollJoints = 15;

struct Ragdoll {
  std::array<BodyId, kRagdollBodies> bodies;
  std::array<JointId, kRagdollJoints> joints;
};

/// A figure of 1.8 m and 72 kg that stands with its arms down, its feet at this pose's origin, facing z. Where an angle
/// of its joints is free and has no stop, there is none in a human either.
Ragdoll addRagdoll(Build& build, const std::string& name, const Pose& at, const Velocity& velocity = {});

}  // namespace avbd::scenes
