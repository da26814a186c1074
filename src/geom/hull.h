// Hulls: the builder's parts and scaled copies.
#pragma once

#include <avbd/hull.h>

namespace avbd {

/// The hull with every vertex multiplied by scale (components not 0; mirrored where their product is negative). The
/// same hull and scale give the same object while one of its users lives.
std::shared_ptr<const HullData> scaledHull(const std::shared_ptr<const HullData>& hull, Vec3 scale);

}  // namespace avbd
