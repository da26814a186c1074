// Whose the parts of a touch are (SoftTouch).
#pragma once

#include <array>

#include "world/world_data.h"

namespace avbd {

/// A body of each side: what wakes, joins islands and rests for it. Slots.
uint32_t bodyOfFirst(const WorldData& data, const SoftTouch& touch);
inline uint32_t bodyOfSecond(const WorldData& data, const SoftTouch& touch) {
  return data.softs[touch.second].bodies[0];
}

/// Slots of the four bodies of its rows: the point, then the face's corners; the edges' ends; the shape's body, then
/// the corners.
std::array<uint32_t, 4> nodesOf(const WorldData& data, const SoftTouch& touch);
/// How far each of them moves what touches, the first side less than 0; of a place given as SoftTouch::anchor is.
std::array<float, 4> nodeWeights(TouchKind kind, Vec3 place);
/// The shapes that say what the surfaces are like. Slots.
std::array<uint32_t, 2> shapesOf(const WorldData& data, const SoftTouch& touch);

}  // namespace avbd
