// A pair of shapes as it lives between steps.
#pragma once

#include <avbd/events.h>
#include <avbd/world.h>

#include <array>

#include "collide/kept_manifold.h"
#include "geom/manifold.h"

namespace avbd {

inline constexpr uint32_t kNone = 0xffffffffu;  ///< no slot

/// What a contact point remembers.
struct PointMemory {
  uint32_t feature = 0;
  Vec3 lambda;            ///< force of the last substep [N]: along the normal (>= 0), t1, t2
  Vec3 anchorA, anchorB;  ///< where it stuck: relative to the centre of mass, body axes
  float rebound = 0;      ///< [m/s] at which it left the other surface in the last step; 0: it did not
  float impact = 0;       ///< [N] what of lambda.x stopped an approach in the last step: no guess for the next one
  uint8_t sticks = 0;     ///< it did not slip in the last step
};

/// Of the points of a pair: force over the step so far, with rebounds, as a mean over all of it [N]: as lambda.
using PointMeans = std::array<Vec3, kMaxManifoldPoints>;

/// Two shapes whose bounds overlap, with their contact points. A pair with a surface owns a run of these: one for each
/// patch that it touched at most so far, numbered from 0; those that are not in use have no points.
///
/// In the order of use: of most pairs that do not touch only the first two cache lines are needed.
struct alignas(64) PairData {
  uint32_t shapeA = 0, shapeB = 0;  ///< slots, A < B
  uint32_t bodyA = 0, bodyB = 0;    ///< slots
  uint32_t generation[4] = {};      ///< of the ids of shapeA, shapeB, bodyA, bodyB, which may be destroyed by now
  uint16_t patch = 0;               ///< place in the run
  uint16_t material = 0;            ///< of the surface: index in ShapeData.materials
  uint32_t element = kNoElement;    ///< triangle of the surface
  bool hasSurface = false;          ///< one of the shapes is a Mesh or HeightField
  bool isTrigger = false;           ///< one of the shapes is: no points, only `touching`
  bool triggerIsA = false;          ///< of a trigger: which of the two
  bool reports = true;              ///< its begin and end are events; a particle's are of its soft body (SoftPair)
  bool wantsHits = false;           ///< so are its hits
  bool hasHook = false;             ///< the contact hook sees it
  bool isFull = false;              ///< in this substep its rows are those of a FullContact
  bool touching = false;            ///< carried force (trigger: overlapped) in this step; of a run in its first entry
  bool wasTouching = false;         ///< the same in the last finished step
  bool touchBegins = false;         ///< in the last finished step: of a run in its first entry
  uint8_t slides = 0;               ///< steps since any point stuck, saturating: from 2 on friction is dynamic
  bool landedSliding = false;       ///< friction is dynamic from the first step on, until a point sticks
  int32_t pointCount = 0;           ///< of `points`: those of the last step
  uint8_t gonePoints = 0;  ///< where there are none any more: how many pushed earlier in this step, as they were then
  /// In WorldData::means, where the step has substeps or something rebounded in it; else the points' lambda says it
  /// all.
  uint32_t mean = kNone;
  KeptManifold kept;                                        ///< of two convex shapes, as long as they hardly move
  float staticFriction = 0, friction = 0, restitution = 0;  ///< combined
  float torsionalFriction = 0, rollingFriction = 0;         ///< combined [m]
  Vec3d origin;  ///< A's centre of mass at the start of the substep that found the manifold
  /// Positions relative to origin. With no points it keeps the normal and the first point of its last ones, until they
  /// are no longer the run's latest: then the normal is zero.
  Manifold manifold;
  Vec3 normal, t1, t2;  ///< basis that the memories are given in
  PointMemory points[kMaxManifoldPoints];
  Vec3 turn;    ///< of A against B since its turning sticks [rad]: about the normal, t1, t2
  Vec3 torque;  ///< against turning in the last step [N m], likewise
  /// Its manifold and its basis say something: of a pair that neither touches nor just did they are left-overs.
  bool hasContact() const {
    return pointCount > 0 || gonePoints > 0 || manifold.count > 0 || wasTouching || touching || hasSurface;
  }
  uint64_t key() const { return uint64_t(shapeA) << 32 | shapeB; }
  ShapeId shapeId(int side) const { return {(side ? shapeB : shapeA) + 1, generation[side]}; }
  BodyId bodyId(int side) const { return {(side ? bodyB : bodyA) + 1, generation[2 + side]}; }
};

}  // namespace avbd
