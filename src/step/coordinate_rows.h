// Rows of one coordinate of a joint or coupling: what its limits, drive, spring, friction and inertia come to.
#pragma once

#include "avbd/rows/d6_joint.h"
#include "step/step_data.h"

namespace avbd {

/// What a coordinate is to do, and where it stands when its rows are made.
struct CoordinateState {
  const D6Axis& definition;
  const JointMultipliers& lambda;  ///< of the last step
  int axis = 0;                    ///< of D6Axes
  double lock = 0;                 ///< of a locked one: where it is held
  float speed = 0;                 ///< [m/s, rad/s] at the start
  /// The same as the mean over the way there, for an armature: where the frame turns, a chord lacks half the step's
  /// centrifugal part, and so does the end that the row compares with.
  float chordSpeed = 0;
  float w = 0;           ///< inverse mass that its rows feel; 0 where nothing can move
  float massless = 0;    ///< sum of the bodies' inverse masses
  float correction = 0;  ///< [m/s, rad/s] at which what lies beyond a stop is brought back at most
  float force = 0;       ///< given by the user
  bool inTree = false;
};

/// Stiffness in use and share of a row of finite stiffness: exact at once in a tree; elsewhere its stiffness in use is
/// bounded by rho, and its multiplier finds the rest.
struct ElasticRow {
  float k = 0, s = 0;
};
ElasticRow elasticRow(float stiffness, float rho, bool inTree);
/// rho of rows that feel the inverse mass w.
float stiffnessInUse(const StepData& step, float w);
/// How stiff a row that feels w is at least by what it carries, a multiplier: on bodies of the reduced mass 1 /
/// massless its force moves the row by no more than a share of a free fall.
float loadInUse(const StepData& step, float w, float massless);

/// Where a drive pulls to and with how much at most; its stiffness and damping are times `inertia`, which is 1 but of
/// acceleration drives. The stiffness that they come to.
float fillDriveOf(const StepData& step, const JointDrive& drive, float inertia, rows::D6Axis<float>& x);
/// Fills all of x but `start`, and the coordinate's bits.
void fillCoordinate(const WorldData& world, const StepData& step, const CoordinateState& at, rows::D6Axes& axes,
                    rows::D6Axis<float>& x);
JointMultipliers multipliersOf(const rows::D6Axis<float>& x);

}  // namespace avbd
