// Joints over any number of bodies: pulleys, couplings between joints, and the user's own. Their rows are evaluated one
// at a time into a buffer, each with its J for every body, and are augmented-Lagrangian rows wherever they stand: no
// tree holds what ties its branches together.
#pragma once

#include <avbd/custom_joint.h>

#include "base/coupling_curve.h"
#include "solve/scalar_joint.h"

namespace avbd {

inline constexpr int kLinkBodies = 16;  ///< of a coupling: two for each of its terms
inline constexpr int kLinkTerms = 8;
inline constexpr int kLinkRows = 7;  ///< most that one can emit: those of one coordinate

/// A row of the buffer. J about each body's centre of mass.
struct LinkedRow {
  float C = 0, k = 0, s = 0, lower = 0, upper = 0;
  float force = 0;  ///< of a stamped row
  float* lambda = nullptr;
  rows::Twist<float> j[kLinkBodies];
};

struct LinkedRows {
  int count = 0;
  /// From each centre of mass to where the joint takes hold, for the geometric stiffness; zero of users' joints.
  rows::V3<float> arm[kLinkBodies] = {};
  LinkedRow row[kLinkRows];
};

/// A rope from a point of each of two bodies to a fixed wheel.
struct PulleyRows {
  rows::V3<float> arm[2];     ///< centre of mass to the point at the start
  rows::V3<float> offset[2];  ///< from the wheel to the point at the start
  float start[2] = {};        ///< lengths at the start
  float ratio = 1;
  float held = 0;  ///< what the rope may grow in this step
  bool slack = true;
  float k = 0, load = 0, lambda = 0;  ///< load as D6Axis::load
  float lambdaAcross[4] = {};         ///< always 0
};

/// A sum over coordinates of scalar joints; its own coordinate counts from the step's start.
struct CouplingRows {
  struct Term {
    uint32_t scalar = 0;  ///< in BatchView::scalar
    int axis = 0;
    CouplingCurve curve;
  };
  Term term[kLinkTerms];
  int terms = 0;
  double start = 0;  ///< the sum at the start
  rows::D6Axes axes;
  rows::D6Axis<float> axis;
};

/// A family of the user's.
struct CustomRows {
  const CustomFamily* family = nullptr;
  std::span<const float> constants, memory;
  CustomBody start[4];
  Vec3 center[4];  ///< centre of mass in the body's frame
  int bodies = 0, rows = 0;
  float h = 0;
  float held[kCustomRows] = {};  ///< of hard rows: what C leaves uncorrected
  float rho[kCustomRows] = {};   ///< stiffness of hard rows in use
  float lambda[kCustomRows] = {};
};

struct LinkedJoint {
  enum class Kind : uint8_t { Pulley, Coupling, Custom };
  Kind kind = Kind::Pulley;
  uint32_t slot = 0;    ///< of the world's joint
  uint32_t island = 0;  ///< of the batch
  int bodies = 0;
  uint32_t row[kLinkBodies] = {};   ///< body rows
  uint8_t first[kLinkBodies] = {};  ///< of a body that stands in the joint more than once: where it does so first
  PulleyRows pulley;
  CouplingRows coupling;
  CustomRows custom;
  LinkedRows stamped;  ///< what the products with H take: J, and k as it is in the Hessian
};

/// As of the rows of a scalar joint outside of trees.
inline rows::PairRow<float> withoutJacobian(const LinkedRow& row) {
  return {row.C, {}, {}, row.k, row.s, row.lower, row.upper};
}
RowForce forceOf(const LinkedRow& row);

/// The rows at the bodies' present displacements.
void evaluate(LinkedJoint& joint, const BatchView& view, LinkedRows& out);
/// J of a body, together wherever it stands in the joint; zero but at its first place.
rows::Twist<float> jacobianOf(const LinkedJoint& joint, const LinkedRow& row, int body);
/// J^T lambda on the first body, of the rows that `stamped` holds.
rows::Twist<float> reactionOf(const LinkedJoint& joint);
/// L of a coupling less what it was at the start, its J by body, and the arms.
float couplingMeasure(const LinkedJoint& joint, const BatchView& view, rows::Twist<float> (&j)[kLinkBodies],
                      rows::V3<float> (&arm)[kLinkBodies]);
/// A user's body where it is now.
CustomBody customBody(const CustomRows& custom, int body, const rows::Twist<float>& moved);

/// Adds all to gradient and Hessian and keeps what the products need; hard rows' multipliers first times `leak`.
void stampLinked(const BatchView& view, float leak, const uint8_t* active);
/// The multipliers become the forces of the linear solution x: what the curvature of C leaves of it, times a large k,
/// is no force.
void takeLinkedForces(const BatchView& view, const uint8_t* active);
/// The same by the rows where the bodies are now, of block sweeps.
void moveMultipliers(LinkedJoint& joint, const BatchView& view, float leak);
/// q += their part of H p.
void multiplyLinked(const BatchView& view, const uint8_t* active);
void updateLinked(const BatchView& view);

}  // namespace avbd
