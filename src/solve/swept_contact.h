// Contacts that two bodies meet only on their way, at a pose far from that of the step's start.
//
// What the rows of other contacts take from the start of the step, arms and gap, is of no use there. So such a contact
// knows points of one body and a plane of the other, each fixed on its own, and its C is their distance at the pose
// that the iterations stand at:
//
//   C = n . (x - q) - offset      x: point with its ball's radius, q: point of the plane, n from A to B
//
// (the other way round where A carries the plane). J has its arms at the same pose: to where the point is, on both
// bodies, which is the exact derivative, since n and q turn with the plane's body. The rows in the tile stay linear;
// each outer iteration puts them anew. Friction pulls to where the two were when they met.
#pragma once

#include "solve/batch.h"

namespace avbd {

/// All vectors in world axes; what is fixed on a body, as it stands at the start of the step.
struct SweptContact {
  uint32_t lane = 0;                  ///< in the batch's contacts
  bool isFull = false;                ///< or full contacts
  bool planeOnA = false;              ///< whose plane
  bool turns = true;                  ///< the plane, with its body; one that only touches something round does not
  bool whips = false;                 ///< the bodies may turn far once they are held
  int count = 0;                      ///< points, in the order of the rows
  rows::V3<float> n, plane;           ///< normal; a point of the plane from its body's centre
  rows::V3<float> core[4];            ///< from the other body's centre
  float radius = 0;                   ///< of balls about them
  float offset[4] = {};               ///< [m] C is 0 where the point is so deep
  rows::V3<float> between;            ///< from A's centre to B's
  rows::Twist<float> metA{}, metB{};  ///< how far the bodies have moved when they meet
  rows::V3<float> belt{0, 0, 0};      ///< [m] how far B's surface shall slide over A's instead
};

/// Distance of a point beyond the plane, where the bodies have moved so far.
float depthOf(const SweptContact& contact, int point, const rows::Twist<float>& dA, const rows::Twist<float>& dB);
/// The rows linearised where the bodies have moved so far. Stiffness, multipliers and friction stay.
void linearise(const SweptContact& contact, const rows::Twist<float>& dA, const rows::Twist<float>& dB,
               rows::Contact<float>& rows);
/// All swept contacts of a batch where its iterations stand.
void lineariseSwept(const BatchView& view);
/// Adds to the Hessian how their forces' torques change as the bodies turn: such forces are large, and so are the
/// turns.
void stiffenSwept(const BatchView& view);

}  // namespace avbd
