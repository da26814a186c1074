// Touches of the surfaces of soft bodies: with each other, with themselves, with shapes.
#pragma once

#include "step/near_features.h"
#include "step/near_shapes.h"
#include "step/step_data.h"

namespace avbd {

/// Fills step.softTouches; those between what sleeps as they were.
void findSoftTouches(const WorldData& world, StepData& step);
void fillSoftTouches(const WorldData& world, StepData& step);  ///< 50_begin_rows
void publishSoftTouches(WorldData& world, StepData& step);     ///< 90_publish
/// Keeps apart what the solve would take through each other (continuous_soft.cpp).
void stopSofts(WorldData& world, StepData& step);  ///< 75_continuous

/// Whether nothing that touches moves.
bool sleeps(const WorldData& world, const SoftTouch& touch);
/// [m] between the middles of two features' surfaces that touch: the radii of both, but within one body less than what
/// parts them at rest.
float thicknessOf(const WorldData& world, const NearFeatures& near);
/// How two features lie at the start of the step.
struct FeatureContact {
  Vec3 place, off;  ///< [m] as of NearestFeatures
  float distance = 0;
  bool counts = true;  ///< not the same place as another feature's, nor behind a solid's surface
};
FeatureContact featureContact(const WorldData& world, const SoftSurfaces& surfaces, const NearFeatures& near);
/// Whether two features were apart, and would not pass through each other on the way out of a solid.
bool mayMeet(const WorldData& world, const NearFeatures& near, const FeatureContact& contact);
/// As near as features of a thickness may come in a step that start at a distance: a share of either.
Kept keptOf(float thickness, float distance);
Kept keptOf(const WorldData& world, const NearFeatures& near, float distance);
/// As deep as a face may come into a shape.
Kept keptOf(const ShapePiece& piece, float thickness, float distance);
/// When two features come nearer than that on their ways; more than 1: never.
float meetingTime(const WorldData& world, const SoftSurfaces& surfaces, const NearFeatures& near);
/// The rows of two features as they are at a time.
FoundTouch touchAt(const WorldData& world, const NearFeatures& near, float time);
/// The same of a shape and a face of a body.
float meetingTime(const WorldData& world, const StepData& step, uint32_t soft, const ShapePiece& piece, uint32_t face);
/// The touch of a shape and a face as they are at a time, seen from the start of the step.
FoundTouch touchAt(const WorldData& world, const StepData& step, uint32_t soft, const ShapePiece& piece, uint32_t face,
                   float time);
/// The face with its ways, the drift too.
MovingFace movingFace(const WorldData& world, const SoftSurfaces& surfaces, uint32_t soft, uint32_t face);
/// A place on a face.
struct OnFace {
  uint32_t soft = kNone, face = 0;
  Vec3 weights, normal;  ///< from the face to what touches it
  float distance = 0;    ///< [m] of the shape
};
/// The touch of a shape's point at the start of the step.
FoundTouch shapeTouch(const WorldData& world, const OnFace& on, const ShapePiece& piece, Vec3 point);
/// Adds a touch with what it remembers. found.touch has all but that.
void addTouch(const WorldData& world, StepData& step, FoundTouch found);
/// What the last step knew of a point and a body of faces, or of the same two features; null: nothing.
const SoftTouch* rememberedTouch(const WorldData& world, const SoftTouch& touch);
/// Whether filters and exclusions let the bodies of two features touch.
bool mayTouchSoft(const WorldData& world, const SoftTouch& touch);

// The searches, which add to step.softTouches.
void findPointTouches(const WorldData& world, StepData& step);    ///< points and faces of solids (soft_points.cpp)
void findFeatureTouches(const WorldData& world, StepData& step);  ///< soft_features.cpp
void findShapeTouches(const WorldData& world, StepData& step);    ///< soft_shapes.cpp

}  // namespace avbd
