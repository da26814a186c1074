// One joint of an articulation: what it leaves free, where frame B is in frame A at given coordinates, and how it
// moves.
#pragma once

#include <avbd/joint.h>
#include <avbd/world.h>

#include <array>
#include <optional>
#include <span>

#include "api/articulation_math.h"
#include "world/check.h"

namespace avbd::articulation {

/// The bodies of a joint, null for the world.
struct JointEnds {
  BodyId a, b;
};

struct JointModel {
  JointEnds ends;
  Posed frameA, frameB;  ///< in each body's frame
  bool ball = false;
  int count = 0;  ///< of the coordinates that it leaves free
  std::array<JointAxis, 6> axes{};
  std::array<double, 6> armature{};
};

/// Hinges, sliders, balls, D6 and fixed joints: those that a tree can have.
bool isTreeJoint(JointType type);
/// Of a joint that a tree can have.
JointModel readJoint(const World& world, JointId id);

/// Of frame B in frame A; q has `count` numbers.
Posed relativePose(const JointModel& joint, std::span<const double> q);

/// How frame B moves against frame A, along A's axes and at B's origin.
struct JointSubspace {
  std::array<Spatial, 6> columns;  ///< of each coordinate's unit velocity
  Spatial velocity;                ///< columns times v
  Spatial rate;                    ///< rate of the columns times v
};
JointSubspace subspace(const JointModel& joint, std::span<const double> q, std::span<const double> v);

}  // namespace avbd::articulation
