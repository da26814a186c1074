// What touches soft bodies, for contacts and events: a soft body counts as one thing with all its particles.
#pragma once

#include "world/pairs.h"

namespace avbd {

/// The soft body that a shape touches for, slot; kNone: for itself, as a trigger that a particle carries does.
inline uint32_t wholeOf(const WorldData& data, uint32_t shape) {
  return data.shapes[shape].isTrigger ? kNone : data.bodies[data.shapes[shape].body].soft;
}
/// A shape or its soft body as half of a key: soft bodies are above all slots of shapes.
inline uint32_t thingOf(const WorldData& data, uint32_t shape) {
  constexpr uint32_t kSoftThing = 0x80000000u;
  const uint32_t soft = wholeOf(data, shape);
  return soft == kNone ? shape : kSoftThing | soft;
}
/// SoftPair::key.
inline uint64_t thingPair(const WorldData& data, uint32_t shapeA, uint32_t shapeB) {
  return slotPair(thingOf(data, shapeA), thingOf(data, shapeB));
}
/// Null of a body that is no particle.
inline SoftId softOfBody(const WorldData& data, uint32_t body) {
  return isParticle(data, body) ? data.softIds.id(data.bodies[body].soft) : SoftId{};
}
/// With the ids of two shapes.
SoftPair softPair(const WorldData& data, uint32_t shapeA, uint32_t shapeB);
/// Of two shapes, one of them a particle's.
TouchPhase softPhase(const WorldData& data, uint32_t shapeA, uint32_t shapeB);
Contact contactOf(const WorldData& data, const SoftContact& contact);

}  // namespace avbd
