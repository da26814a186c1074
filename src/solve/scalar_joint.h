// Joints whose rows are evaluated one at a time: which rows they have differs from joint to joint, so lanes would idle.
//
// Every row falls into one of three kinds, anew in each iteration:
// - exact: hard rows of a tree, met by a multiplier that the tree finds; one-sided ones while they push.
// - elastic: force k C + s lambda within its bounds, with k in the Hessian: springs, drives, friction that sticks, and
//   in loops all hard rows too.
//   At a bound the Hessian is a majoriser, as in contacts: k times the share of the trial force that the bound allows.
// - none: one-sided rows that do not push. A given force is elastic with k = 0.
#pragma once

#include <vector>

#include "avbd/rows/d6_joint.h"
#include "avbd/rows/distance.h"
#include "avbd/rows/sinks.h"
#include "solve/batch.h"

namespace avbd {

/// Stiffness of hard rows that no tree solves: rho = this / (w h^2). More would help a mechanism's loops, but where
/// rows say the same twice, as five-row hinges of a plane mechanism do, the rounding of C times k is a force that only
/// the leak bounds, and eats energy: a slider-crank at 240 Hz loses 0.1 % in 10 s with this and 10 % with 100,000.
inline constexpr float kJointFactor = 3000;

/// Of the stiffness of a row that no tree solves, by which a one-sided row weighs its violation against its multiplier:
/// the mass that it feels over h^2. By more, what Newton's step leaves of a curved C would release rows that push.
inline constexpr float kActiveShare = 1 / kJointFactor;

/// Most rows that a joint can emit: of six axes six each, and two of a cone; a turn to a rotation replaces three
/// drives.
inline constexpr int kScalarRows = 38;

struct ScalarJoint {
  enum class Kind : uint8_t { D6, Distance };
  rows::D6Joint<float> rows;  ///< D6
  rows::Distance<float> distance;
  rows::D6Axes axes;
  Kind kind = Kind::D6;
  uint32_t rowA = 0, rowB = 0;  ///< body rows; the static row for the world
  uint32_t slot = 0;            ///< of the world's joint
  uint32_t island = 0;          ///< of the batch
  bool inTree = false;
  rows::Twist<float> reaction;  ///< of A, about its anchor, at the end of the substep: 90_publish
};

/// The rows of a joint at one pose.
using ScalarRows = rows::ProbeSink<float, kScalarRows>;
ScalarRows rowsOf(ScalarJoint& joint, const BatchView& view);

enum class RowKind : uint8_t { None, Exact, Elastic };

struct RowForce {
  RowKind kind = RowKind::None;
  float force = 0;  ///< of an exact row its multiplier
  float k = 0;      ///< in the Hessian, of elastic rows
};
RowForce forceOf(const rows::PairRow<float>& row, float lambda, bool inTree);
/// The force as the multiplier that comes next: within the row's bounds.
float multiplierOf(const rows::PairRow<float>& row, float lambda, bool inTree);

/// What a joint's rows add up to about their reference point: the wrench on A, and the stiffness of elastic rows.
struct ScalarStamp {
  rows::Twist<float> wrench = rows::zeroTwist<float>();
  rows::Sym6<float> stiffness = rows::zeroSym6<float>();
};
ScalarStamp stampOf(const ScalarJoint& joint, const ScalarRows& list);

/// lambda <- force of all rows that no tree solves exactly, of hard ones times `leak`; one-sided rows of a tree that
/// let go forget theirs.
void moveMultipliers(ScalarJoint& joint, const BatchView& view, float leak);

/// Adds the joints of loops to gradient and Hessian, and keeps what the products need of all; with `dual` moves the
/// multipliers first. `active`: by island of the batch, those that take part.
void stampScalar(const BatchView& view, float leak, bool dual, const uint8_t* active);
void updateScalar(const BatchView& view);

}  // namespace avbd
