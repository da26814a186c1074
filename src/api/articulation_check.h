// Refuses numbers that an articulation cannot take (articulation.h). All throw Error.
#pragma once

#include <avbd/articulation.h>
#include <avbd/world.h>

#include <span>

#include "world/check.h"

namespace avbd::articulation {

/// Bodies and joints that the view names must live.
void checkLinks(const Path& call, const World& world, const Articulation& tree);

enum class Kind { Positions, Velocities };

/// Numbers of one kind, in the ranges of World::setDrive.
void checkNumbers(const Path& path, std::span<const double> values, const Articulation& tree, Kind kind, float unit);
/// The state with its base's rotation made exact.
ArticulationState checkedState(const Path& call, const World& world, const Articulation& tree,
                               const ArticulationState& state);
/// `count` numbers of forces or accelerations.
void checkForces(const Path& path, std::span<const double> values, size_t count);

}  // namespace avbd::articulation
