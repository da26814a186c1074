// What happened in the last step: contacts, and what began and ended.
#pragma once

#include <avbd/geometry.h>
#include <avbd/id.h>
#include <avbd/joint.h>
#include <avbd/types.h>

#include <array>
#include <vector>

namespace avbd {

inline constexpr uint32_t kNoElement = 0xffffffffu;

/// One point of a contact after the last step. Places are those of the start of the step's last substep. Forces are
/// means over the whole step, all its substeps and rebounds included: times dt they are the impulses of the step. What
/// a point gave that went within the step counts to the nearest one that is left.
struct ContactPoint {
  Vec3d position;      ///< world [m], halfway between the two surfaces
  float separation;    ///< [m] gap along the normal; negative where the shapes overlap
  float normalForce;   ///< [N] >= 0, pushes B along the normal and A against it
  Vec3 frictionForce;  ///< [N] on B
  uint32_t feature;    ///< names the touching features; equal as long as they are the same
};

/// What of their touch (TouchEvent) the last step saw of two shapes. Its end is in Events::ends.
enum class TouchPhase : uint8_t {
  None,     ///< near each other, but no point between them carried force
  Begins,   ///< they touched, but not in the step before
  Persists  ///< they touched in the step before too
};

/// Up to four points between two shapes that share a normal. Two convex shapes have one contact; a shape on a mesh or
/// height field has one for each direction in which it is touched.
struct Contact {
  ShapeId shapeA, shapeB;
  BodyId bodyA, bodyB;
  /// Triangle of a Mesh or HeightField that the first point is on (mesh.h: sourceTriangle); else kNoElement.
  uint32_t elementA = kNoElement, elementB = kNoElement;
  TouchPhase touch = TouchPhase::None;  ///< of the two shapes, by whatever point
  Vec3 normal;                          ///< unit, from A to B
  int pointCount = 0;
  std::array<ContactPoint, 4> points;
};

/// A face or edge of a soft body and what it touches, which no Contact tells: a point or an edge of another one or of
/// itself, or a shape that is none of its points' balls.
struct SurfaceTouch {
  SoftId soft;     ///< whose face or edge it is
  SoftId other;    ///< the soft body whose point or edge touches it; null where a shape does
  ShapeId shape;   ///< of a rigid body that touches it; else null
  BodyId body;     ///< whose shape that is; else null
  Vec3d position;  ///< world [m], on the face or edge of `soft`
  Vec3 normal;     ///< unit, from `soft` to what touches it
  /// [N] of the last substep, >= 0: pushes what touches along the normal and the face or edge against it.
  float normalForce = 0;
  Vec3 frictionForce;  ///< [N] on what touches
};

/// Two shapes began or ceased to touch: have, or no longer have, a point that carries force. Ids may be of shapes
/// destroyed since. A touch shorter than a step begins in it, and ends in it or the next.
struct TouchEvent {
  ShapeId shapeA, shapeB;
  BodyId bodyA, bodyB;
  Vec3d position;     ///< world [m], of a point between them: of a begin the one that pushed most, of an end the last
  Vec3 normal;        ///< unit, from A to B, there
  float impulse = 0;  ///< [N s] >= 0 along the normal over this step, of all their points
};

/// A shape entered or left a trigger (ShapeDef::isTrigger). Ids may be of shapes destroyed since.
struct TriggerEvent {
  ShapeId trigger, visitor;
  BodyId triggerBody, visitorBody;
};

/// Two shapes met faster than WorldDef::hitSpeed.
struct HitEvent {
  ShapeId shapeA, shapeB;
  BodyId bodyA, bodyB;
  Vec3d position;     ///< world [m]
  Vec3 normal;        ///< unit, from A to B
  float speed = 0;    ///< [m/s] > 0, of approach along the normal at the start of the step
  float impulse = 0;  ///< [N s] along the normal over the step, of all their points, rebound included
};

/// A joint broke (JointBreak).
struct BreakEvent {
  JointId joint;
  JointReaction reaction;  ///< with which it broke
};

/// A body moved in the last step.
struct MoveEvent {
  BodyId body;
  Pose pose;  ///< of the body's frame
  uint64_t userData = 0;
};

/// Everything that happened in the last step (all its substeps), each list ordered by ids. Touches that persist are
/// in World::contacts(), with their points and forces.
struct Events {
  std::vector<TouchEvent> begins, ends;
  std::vector<TriggerEvent> enters, leaves;
  std::vector<HitEvent> hits;
  std::vector<BreakEvent> breaks;
  std::vector<MoveEvent> moves;  ///< only with WorldDef::moveEvents
  /// Dynamic bodies that fell asleep or woke since the end of the step before, by whatever cause.
  std::vector<BodyId> sleeps, wakes;
};

/// A contact about to be solved, as the contact hook sees it. The fields below the line may be changed.
struct ContactPlan {
  ShapeId shapeA, shapeB;
  BodyId bodyA, bodyB;
  uint32_t elementA = kNoElement, elementB = kNoElement;
  Vec3 normal;  ///< unit, from A to B
  int pointCount = 0;
  std::array<Vec3d, 4> positions;    ///< world [m]
  std::array<float, 4> separations;  ///< [m]
  std::array<Vec3, 4> velocities;    ///< of B against A at the points [m/s]

  // ----
  float staticFriction = 0, friction = 0, restitution = 0;  ///< as in Material
  float torsionalFriction = 0, rollingFriction = 0;         ///< [m]
  /// [m/s] at which B's surface shall slide over A's: a conveyor belt. The part along the normal is ignored.
  Vec3 surfaceVelocity{};
  /// Factors on the inverse mass and inertia of each body as this contact feels them: 0 makes it immovable to the
  /// contact, 1 is natural. Finite, 0 .. 1e3. Momentum is kept only where both are equal.
  float inverseMassScaleA = 1, inverseMassScaleB = 1;
};

}  // namespace avbd
