// Points of soft bodies against faces of others.
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Fills step.softTouches; those between bodies that both sleep as they were.
void findSoftTouches(const WorldData& world, StepData& step);
void fillSoftTouches(const WorldData& world, StepData& step);     ///< 50_begin_rows
void publishSoftTouches(WorldData& world, const StepData& step);  ///< 90_publish

/// The nearest point of a triangle, by its corners' weights.
struct NearestOnFace {
  Vec3 weights, point;
};
NearestOnFace nearestOnFace(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace avbd
