// Touches of shapes and faces of soft bodies: what the points of the soft body do not find, which is a corner or an
// edge of the shape within a face or across an edge.
#include <algorithm>

#include "step/contacts.h"
#include "step/free_motion.h"
#include "step/near_shapes.h"
#include "step/soft_touches.h"

namespace avbd {

namespace {

constexpr float kCorner = 0.999f;  ///< weight of a corner that the place is at: its point has touches of its own

/// What is far away for the size of the faces has rows only if it meets, and as it is then.
void meetLater(const WorldData& world, StepData& step, uint32_t slot, const ShapePiece& piece, uint32_t face) {
  const float time = meetingTime(world, step, slot, piece, face);
  if (time > 1) return;
  const FoundTouch found = touchAt(world, step, slot, piece, face, time);
  if (mayTouchSoft(world, found.touch)) addTouch(world, step, found);
}

void meet(const WorldData& world, StepData& step, uint32_t slot, const ShapePiece& piece, uint32_t face) {
  const SoftData& soft = world.softs[slot];
  const SoftPlace& place = step.softs.places[slot];
  const auto& corner = soft.mesh->surface()[face];
  const Vec3 v[3] = {place.points[corner[0]], place.points[corner[1]], place.points[corner[2]]};
  const float size = soft.mesh->faceSize(), margin = touchMargin(world);
  const Nearest near = nearestToFace(piece, piece.pose, v, margin + soft.radius + size);
  if (near.apart) return meetLater(world, step, slot, piece, face);
  const Vec3 weights = nearestOnFace(near.pointB, v[0], v[1], v[2]).weights, normal = -near.normal;
  if (std::max({weights.x, weights.y, weights.z}) > kCorner) return;
  const float front = dot(normal, piece.front);  // the surface is before the piece's front
  if (piece.front != Vec3{} && front > 0) return;
  const Vec3 way = place.drift + place.ways[corner[0]] * weights.x + place.ways[corner[1]] * weights.y +
                   place.ways[corner[2]] * weights.z;
  const float closing = dot(normal, way - piece.wayOf(near.pointA));
  if (near.distance - soft.radius > margin + std::min(std::max(closing, 0.0f), size)) return;
  if (!soft.mesh->isCloth() && dot(place.normals[face], normal) <= 0) return;
  const FoundTouch found = shapeTouch(world, {slot, face, weights, normal, near.distance}, piece, near.pointA);
  const SoftTouch* old = rememberedTouch(world, found.touch);
  if (old && near.distance < 0 && dot(old->normal, normal) < 0) return;  // it came from the other side
  if (mayTouchSoft(world, found.touch)) addTouch(world, step, found);
}

}  // namespace

FoundTouch shapeTouch(const WorldData& world, const OnFace& on, const ShapePiece& piece, Vec3 point) {
  FoundTouch found;
  found.touch = piece.namesWith(on.soft, on.face).touch();
  found.touch.normal = on.normal;
  found.touch.anchor = on.weights;
  found.arm = point - piece.center;
  found.touch.place = toBody(world.bodies[world.shapes[piece.shape].body], found.arm);
  found.separation = on.distance - world.softs[on.soft].radius;
  return found;
}

FoundTouch touchAt(const WorldData& world, const StepData& step, uint32_t slot, const ShapePiece& piece, uint32_t face,
                   float time) {
  const MovingFace moving = movingFace(world, step.softs, slot, face);
  const Vec3 v[3] = {moving.when(0, time), moving.when(1, time), moving.when(2, time)};
  const Nearest near = nearestToFace(piece, piece.when(time), v, 1e30f);
  const Vec3 w = nearestOnFace(near.pointB, v[0], v[1], v[2]).weights;
  const Vec3 arm = rotate(quatFromVector(piece.turn * -time), near.pointA - piece.center - piece.linear * time);
  const Vec3 point = piece.center + arm, onFace = moving.at[0] * w.x + moving.at[1] * w.y + moving.at[2] * w.z;
  return shapeTouch(world, {slot, face, w, -near.normal, dot(-near.normal, point - onFace)}, piece, point);
}

void findShapeTouches(const WorldData& world, StepData& step) {
  world.softIds.forEach([&](uint32_t slot) {
    forEachNearShape(world, step, slot, false,
                     [&](const ShapePiece& piece, uint32_t face) { meet(world, step, slot, piece, face); });
  });
}

}  // namespace avbd
