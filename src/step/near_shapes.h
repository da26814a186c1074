// Shapes that come near faces of a soft body, piece by piece: convex shapes whole, surfaces by their triangles.
#pragma once

#include "base/function_ref.h"
#include "collide/convex.h"
#include "collide/face_features.h"
#include "step/step_data.h"

namespace avbd {

/// A convex shape, or a triangle of a surface, in the frame of a soft body.
struct ShapePiece {
  uint32_t shape = kNone;  ///< slot
  uint32_t part = 0;       ///< triangle of a surface
  ShapeGeom geom;
  NearPose pose;
  Vec3 center;        ///< of mass of its body
  Vec3 linear, turn;  ///< [m, rad] its body's way in the step
  Vec3 front;         ///< of a triangle with one side; else 0
  float reach = 0;    ///< [m] of the body about its centre
  float thin = 0;     ///< [m] half thickness of the body; 0 of a triangle

  NearPose when(float time) const;
  /// As a touch with a face of a soft body is named.
  FeatureNames namesWith(uint32_t soft, uint32_t face) const { return {TouchKind::ShapeFace, shape, part, soft, face}; }
  Vec3 wayOf(Vec3 point) const { return linear + cross(turn, point - center); }
};

/// Calls f(piece, face) for all that may meet while the body's points go their ways (SoftPlace) and shapes those of
/// their bodies: as their velocities say, or as they are solved. Not for triggers, particles and half spaces.
void forEachNearShape(const WorldData& world, StepData& step, uint32_t soft, bool solved,
                      FunctionRef<void(const ShapePiece&, uint32_t face)> f);

/// Nearest points of a piece at a pose (a) and a face (b).
Nearest nearestToFace(const ShapePiece& piece, const NearPose& pose, const Vec3 (&face)[3], float beyond);

/// A face of a soft body on its way.
struct MovingFace {
  Vec3 at[3], way[3];
  Vec3 when(int i, float time) const { return at[i] + way[i] * time; }
};
/// [m] by which the two come nearer over the step, at most.
float fastestApproach(const ShapePiece& piece, const MovingFace& face);
/// The first time 0 .. 1 at which the two meet; more than 1: never.
float pieceMeetsFace(const ShapePiece& piece, const MovingFace& face, Kept kept);

}  // namespace avbd
