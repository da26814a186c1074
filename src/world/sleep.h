// Sleep between steps: what wakes what, and the lists of what is awake.
//
// Waking takes effect at once for the bodies; their pairs and joints stay with their island until the lists are brought
// up to date, for all that woke since at once. Bodies of one island rest on each other, so all of it wakes. Pairs that
// have no points and do not touch are not kept: the shapes of what wakes are marked unpaired and find theirs anew.
#pragma once

#include <span>

#include "world/world_data.h"

namespace avbd {

/// A dynamic body that does not sleep, or a kinematic one that moves.
inline bool isAwake(const WorldData& data, uint32_t body) { return !data.bodies[body].asleep; }

inline bool hasVelocity(const BodyData& body) {
  return body.linearVelocity != Vec3{} || body.angularVelocity != Vec3{};
}

/// A new body goes to where it belongs.
void enlist(WorldData& data, uint32_t body);
/// A dynamic body with all that sleeps with it, and begins to count its rest anew; of another, all that rests on it.
/// kNone is the world, which moves nothing.
void wakeBody(WorldData& data, uint32_t body);
void wakeIsland(WorldData& data, uint32_t island);
void wakeJoint(WorldData& data, uint32_t joint);  ///< all bodies that it acts on
void wakeAll(WorldData& data);
/// A kinematic body was given a velocity.
void wakeKinematic(WorldData& data, uint32_t body);
/// What sleeps where the shapes of a body are now: by its bounds.
void wakeAround(WorldData& data, uint32_t body);
/// A dynamic body, with all that it has points with or is jointed to.
void putToSleep(WorldData& data, uint32_t body);

/// Pairs and joints of what woke return to the lists, what is gone leaves them.
void updateAwake(WorldData& data);
/// Of one island; `keep` leaves it as it is, so that the waking can be undone.
void returnWoken(WorldData& data, bool keep);
void freeIsland(WorldData& data, uint32_t island);

/// These bodies, ascending, are one island from now on, but for their pairs and joints.
void sleepTogether(WorldData& data, std::span<const uint32_t> bodies);
/// Takes pairs and joints without an awake body out of the lists. `keep`: those of islands go to their islands.
void storeAsleep(WorldData& data, bool keep);

}  // namespace avbd
