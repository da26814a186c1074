// Whether a ray meets the solid of a probe's zone.
#pragma once

#include "io/probe.h"

namespace avbd {

/// origin and direction (not zero) in the zone's frame. A ray that starts inside meets it.
bool meets(const ProbeZone& zone, Vec3d origin, Vec3d direction);

}  // namespace avbd
