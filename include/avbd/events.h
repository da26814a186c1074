// What happened in the last step: contacts.
#pragma once

#include <avbd/id.h>
#include <avbd/types.h>

#include <array>

namespace avbd {

/// One point of a contact after the last step.
struct ContactPoint {
  Vec3d position;      ///< world [m], halfway between the two surfaces, where they were when the step began
  float separation;    ///< [m] gap at the start of the step along the normal; negative where the shapes overlap
  float normalForce;   ///< [N] >= 0, mean over the step, pushes B along the normal and A against it
  Vec3 frictionForce;  ///< [N] on B
  uint32_t feature;    ///< names the touching features; equal as long as they are the same
};

/// All points between two shapes.
struct Contact {
  ShapeId shapeA, shapeB;
  BodyId bodyA, bodyB;
  Vec3 normal;  ///< unit, from A to B
  int pointCount = 0;
  std::array<ContactPoint, 4> points;
};

}  // namespace avbd
