// Snapshots: what pairs need of their shapes, close together, as pairs name shapes in no order that memory knows.
#pragma once

#include <limits>
#include <vector>

#include "geom/shape.h"
#include "world/world_data.h"

namespace avbd::snapshot {

struct alignas(64) PairSide {
  Pose last;         ///< BodyData::last
  float radius = 0;  ///< as NearBody::radius
  uint32_t body = kNone;
  uint32_t shapeGeneration = 0, bodyGeneration = 0;
  bool lives = false;  ///< or nothing else is known
  bool isTrigger = false, isSurface = false, isConvex = false, isDynamic = false;
};
using PairSides = std::vector<PairSide>;  ///< by shape slot

inline void fillSides(const WorldData& data, PairSides& sides) {
  sides.assign(data.shapes.size(), PairSide{});
  for (uint32_t slot = 0; slot < sides.size(); ++slot) sides[slot].shapeGeneration = data.shapeIds.id(slot).generation;
  data.shapeIds.forEach([&](uint32_t slot) {
    const ShapeData& shape = data.shapes[slot];
    const BodyData& body = data.bodies[shape.body];
    PairSide& side = sides[slot];
    side.last = body.last;
    side.radius = shape.geom.type == ShapeType::HalfSpace ? std::numeric_limits<float>::infinity() : body.radius;
    side.body = shape.body;
    side.bodyGeneration = data.bodyIds.id(shape.body).generation;
    side.lives = true;
    side.isTrigger = shape.isTrigger;
    side.isSurface = isSurface(shape.geom.type), side.isConvex = isConvex(shape.geom.type);
    side.isDynamic = body.type == BodyType::Dynamic;
  });
}

}  // namespace avbd::snapshot
