// Filters, poses and the fitting of the tree (query.h).
#include "query/query.h"
#include "world/limits.h"
#include "world/pairs.h"

namespace avbd {

Pose shapePose(const WorldData& data, const ShapeData& shape) {
  const BodyData& body = data.bodies[shape.body];
  return {body.position + rotate(body.rotation, toDouble(shape.toMass.p)), body.rotation * shape.toMass.q};
}

bool Sight::sees(uint32_t slot) const {
  const ShapeData& shape = data.shapes[slot];
  const BodyType type = data.bodies[shape.body].type;
  const bool wanted = type == BodyType::Dynamic     ? filter.dynamics
                      : type == BodyType::Kinematic ? filter.kinematics
                                                    : filter.statics;
  return wanted && (filter.triggers || !shape.isTrigger) && shape.body != ignored &&
         filtersMeet(filter.filter, shape.filter);
}

void freshenTree(WorldData& data) {
  for (const uint32_t slot : data.sleep.awake) {
    const BodyData& body = data.bodies[slot];
    if (!data.bodyIds.isAliveSlot(slot) || body.type == BodyType::Static) continue;
    for (uint32_t s = body.firstShape; s != kNone; s = data.shapes[s].next) {
      const ShapeData& shape = data.shapes[s];
      const Pose pose = shapePose(data, shape);
      if (contains(data.tree.box(shape.proxy), bounds(shape.geom, pose, 0))) continue;
      data.tree.move(shape.proxy, bounds(shape.geom, pose, kFatMargin * data.def.lengthUnit));
      markUnpaired(data, s);
    }
  }
}

}  // namespace avbd
