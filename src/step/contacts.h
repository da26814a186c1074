// Parts of the stage 20_contacts.
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Where two shapes are, relative to the centre of mass of the first one's body when the step began.
struct NearPair {
  NearPose a, b;
  float margin = 0;  ///< [m] within which contacts are looked for
};

NearPose nearPose(const BodyData& body, const ShapeData& shape, Vec3d origin);
/// Smaller half thickness of two bodies; a body without bounded shapes does not count.
float smallerSize(const BodyData& a, const BodyData& b);
/// Distance within which contacts are looked for: what the bodies may close in this step, but never a large part of
/// the smaller one's size.
float speculativeMargin(const WorldData& world, const BodyData& a, const BodyData& b, float h);

// Memory (contact_memory.cpp).
inline constexpr float kSameNormal = 0.9f;  ///< cosine: a normal that turned farther keeps no multipliers
/// Of the smaller half thickness: the nearest old point still counts as this one.
inline constexpr float kNearPoint = 0.1f;

/// A point in the body's axes, relative to its centre of mass.
inline Vec3 toBody(const BodyData& body, Vec3 fromCenter) { return rotate(conjugate(body.rotation), fromCenter); }

/// The pair's basis becomes that of its manifold's normal.
void turnBasis(PairData& pair);

/// What a new point continues; null: nothing.
struct KnownPoint {
  const PointMemory* memory = nullptr;
  const ContactBasis* basis = nullptr;
};
/// The manifold is new: turns the basis and carries over what the points remember, `known` one by one.
void rememberPoints(const WorldData& world, PairData& pair, const KnownPoint* known);
/// The same for a pair of convex shapes: finds the points that continue.
void rememberPoints(WorldData& world, const StepData& step, PairData& pair);
/// Point i has what `old` (null: nothing) gave in the substeps before.
void continueForce(WorldData& world, PairData& pair, int i, const OldPoint* old);
/// What a point that is gone gave in them counts to the nearest one of the pair.
void inheritForce(WorldData& world, PairData& pair, const OldPoint& gone);
/// Makes room for the means of a pair that has none yet in this step.
PointMeans& meansOf(WorldData& world, PairData& pair);
/// A contact that begins: whether it does so as a slide. `belt`: at what velocity B's surface shall slide over A's.
void beginSlide(const WorldData& world, const StepData& step, PairData& pair, Vec3 belt);
/// What has pushed in this step stays to be shown.
void forgetContact(const WorldData& world, const StepData& step, PairData& pair);

// Pairs of convex shapes that hardly move against each other (contact_carry.cpp).
/// Manifold and memory from what was kept; false if it has to be found anew.
bool carryContact(WorldData& world, const StepData& step, PairData& pair, float margin);
/// Keeps what was found within the margin, if the next step may use it.
void keepContact(const WorldData& world, PairData& pair, float margin, const Manifold& found);

/// Friction, restitution ... of a pair from the materials of its shapes (contact_materials.cpp).
void combineMaterials(PairData& pair, const Material& a, const Material& b);
struct CombinedMaterial {
  float staticFriction, friction, restitution, torsionalFriction, rollingFriction;
};
CombinedMaterial combined(const Material& a, const Material& b);
/// Penetration beyond the slop, of which only a share is corrected in one step and never faster than allowed; or the
/// whole gap, so that nothing stops short of touching.
inline float normalBias(const WorldData& world, const StepData& step, float separation) {
  const float gap = separation + step.slop;
  if (gap >= 0) return -gap;
  return std::min((1 - step.alpha) * -gap, world.def.maxDepenetrationSpeed * step.h);
}

inline constexpr float kSlipping = 0.999f;  ///< of the cone: a friction force beyond it belongs to a point that slips

/// Whether a point's force (normal, t1, t2) says that it sticks.
inline bool insideCone(Vec3 lambda, float mu) {
  const float friction = lambda.y * lambda.y + lambda.z * lambda.z;
  const float bound = kSlipping * mu * lambda.x;
  return friction < bound * bound;
}

/// Across a normal, as the rows of a contact take it.
struct TouchBasis {
  Vec3 t1, t2;
};
TouchBasis basisOf(Vec3 normal);

/// Patches of the pairs world.pairs[begin .. end), one run, which has a surface; those for which the run is too short
/// go to step.overflow (contact_surface.cpp).
void findPatches(WorldData& world, StepData& step, size_t begin, size_t end);
void findPatches(WorldData& world, StepData& step, size_t begin, size_t end, const NearPair& near);
/// Puts step.overflow into the list, behind the runs that they belong to.
void lengthenRuns(WorldData& world, StepData& step);

/// Brings what a step knows of all contacts up to date once some of them were changed: wakes what is met, asks the
/// hook.
void renewContacts(WorldData& world, StepData& step);

/// Whether a trigger and its visitor overlap (contact_trigger.cpp).
bool overlaps(const WorldData& world, StepData& step, const PairData& pair);

/// Lets the user's hook see and change contacts; throws Error for what it may not say (contact_hook.cpp).
void askHook(WorldData& world, StepData& step);
/// The same for what later rounds of a step have found on the way: the places of all other pairs may have changed.
void askHookAgain(WorldData& world, StepData& step);
/// For askHook: to undo a step that it stops.
void rememberPairs(const WorldData& world, StepData& step);
void restorePairs(WorldData& world, StepData& step);

}  // namespace avbd
