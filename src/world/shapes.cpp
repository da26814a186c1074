// Shapes of bodies between steps (bodies.h).
#include <avbd/hull.h>

#include <algorithm>

#include "geom/triangles.h"
#include "world/bodies.h"
#include "world/limits.h"
#include "world/pairs.h"

namespace avbd {
namespace {

float farthestVertex(const HullData& hull, const NearPose& pose) {
  float far = 0;
  for (const Vec3 v : hull.vertices()) far = std::max(far, length(pose * v));
  return far;
}

float farthestCorner(const Aabb& box, const NearPose& pose) {
  float far = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner{i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                      i & 4 ? box.upper.z : box.lower.z};
    far = std::max(far, length(pose * corner));
  }
  return far;
}

// Distance of the shape's farthest point from the centre of mass, or a bound of it; an unbounded shape has none.
float reach(const ShapeGeom& geom, const NearPose& pose) {
  if (geom.type == ShapeType::Sphere) return length(pose.p) + geom.radius;
  if (geom.type == ShapeType::Capsule) {
    const Vec3 half = rotate(pose.q, geom.extent);
    return std::max(length(pose.p + half), length(pose.p - half)) + geom.radius;
  }
  if (isSurface(geom.type)) return farthestCorner(surfaceBounds(geom), pose);
  if (!isConvex(geom.type)) return 0;
  if (geom.type == ShapeType::Hull) return farthestVertex(geom.hull(), pose) + geom.radius;
  // The corner on the side on which the box lies.
  const Vec3 local = rotate(conjugate(pose.q), pose.p);
  const Vec3 corner{std::abs(local.x) + geom.extent.x, std::abs(local.y) + geom.extent.y,
                    std::abs(local.z) + geom.extent.z};
  return length(corner) + geom.radius;
}

// Of the largest ball in a cone: that of the circle in its section, a triangle of base 2 r and this height.
float coneInnerRadius(float r, float height) { return r * height / (r + std::sqrt(r * r + height * height)); }

float halfThickness(const ShapeGeom& geom) {
  switch (geom.type) {
    case ShapeType::Sphere:
    case ShapeType::Capsule:
      return geom.radius;
    case ShapeType::Cone:
      return geom.radius + coneInnerRadius(geom.extent.x, 2 * geom.extent.y);
    case ShapeType::Hull:
      return geom.radius + geom.hull().innerRadius();
    default:
      return geom.radius + std::min({geom.extent.x, geom.extent.y, geom.extent.z});
  }
}

void placeShape(BodyData& body, ShapeData& shape) {
  shape.toMass = {toFloat(shape.local.position - toDouble(body.center)), shape.local.rotation};
  // A trigger meets nothing.
  if (shape.isTrigger) return;
  body.radius = std::max(body.radius, reach(shape.geom, shape.toMass));
  if (!isConvex(shape.geom.type)) return;
  const float thickness = halfThickness(shape.geom);
  body.minExtent = body.minExtent > 0 ? std::min(body.minExtent, thickness) : thickness;
}

}  // namespace

void placeShapes(WorldData& data, uint32_t slot) {
  BodyData& body = data.bodies[slot];
  body.radius = body.minExtent = 0;
  for (uint32_t s = body.firstShape; s != kNone; s = data.shapes[s].next) placeShape(body, data.shapes[s]);
}

Aabb fatBounds(const WorldData& data, const ShapeData& shape) {
  return bounds(shape.geom, bodyPose(data.bodies[shape.body]) * shape.local, kFatMargin * data.def.lengthUnit);
}

uint32_t addShape(WorldData& data, uint32_t bodySlot, const ShapeDef& def) {
  const uint32_t slot = data.shapeIds.slot(data.shapeIds.create());
  if (slot >= data.shapes.size()) data.shapes.resize(slot + 1);
  BodyData& body = data.bodies[bodySlot];
  ShapeData& shape = data.shapes[slot];
  shape = {};
  shape.geometry = def.geometry;
  shape.geom = toShapeGeom(shape.geometry, shape.scaled);
  shape.local = def.pose;
  shape.material = def.material;
  shape.materials = def.materials;
  shape.filter = def.filter;
  shape.isTrigger = def.isTrigger;
  shape.contactEvents = def.contactEvents;
  shape.hitEvents = def.hitEvents;
  shape.contactHook = def.contactHook;
  data.hookedShapes += shape.contactHook;
  shape.density = def.density;
  shape.userData = def.userData;
  shape.body = bodySlot;
  shape.next = body.firstShape;
  body.firstShape = slot;
  placeShape(body, shape);
  shape.proxy = data.tree.insert(fatBounds(data, shape), slot);
  markUnpaired(data, slot);
  return slot;
}

void removeShape(WorldData& data, uint32_t slot) {
  ShapeData& shape = data.shapes[slot];
  const uint32_t body = shape.body;
  unmarkUnpaired(data, slot);
  std::erase_if(data.softTouches,
                [&](const SoftTouch& touch) { return touch.kind == TouchKind::ShapeFace && touch.first == slot; });
  data.hookedShapes -= shape.contactHook;
  data.tree.remove(shape.proxy);
  uint32_t* link = &data.bodies[body].firstShape;
  while (*link != slot) link = &data.shapes[*link].next;
  *link = shape.next;
  shape = {};
  data.shapeIds.destroy(data.shapeIds.id(slot));
}

std::vector<uint32_t> shapeSlots(const WorldData& data, uint32_t body) {
  std::vector<uint32_t> slots;
  for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next) slots.push_back(s);
  std::reverse(slots.begin(), slots.end());
  return slots;
}

std::vector<ShapeDef> shapeDefs(const WorldData& data, uint32_t body) {
  std::vector<ShapeDef> defs;
  for (const uint32_t slot : shapeSlots(data, body)) {
    const ShapeData& shape = data.shapes[slot];
    defs.push_back(
        {.geometry = shape.geometry, .pose = shape.local, .density = shape.density, .isTrigger = shape.isTrigger});
  }
  return defs;
}

}  // namespace avbd
