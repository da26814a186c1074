// Hulls: made and scaled (hull.h).
#include "geom/hull.h"

#include <avbd/error.h>

namespace avbd {

std::shared_ptr<const HullData> makeHull(const HullDef&) { throw Error("HullDef", "points", "0", "not built yet"); }
std::shared_ptr<const HullData> scaledHull(const std::shared_ptr<const HullData>& hull, Vec3) { return hull; }
MassProperties HullData::massProperties(float) const { return unit_; }

}  // namespace avbd
