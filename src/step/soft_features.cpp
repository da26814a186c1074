// Features of surfaces that touch: points and faces of cloth, points and faces of one body, and edges of any.
#include <algorithm>

#include "avbd/rows/math.h"
#include "step/soft_touches.h"
#include "world/soft.h"

namespace avbd {

namespace {

constexpr float kEnd = 1e-3f;          ///< share of an edge that is its end's
constexpr float kOfRest = 0.5f;        ///< of what parts two features at rest
constexpr float kNoDirection = 1e-3f;  ///< of the thickness: nearer than that nothing tells the direction

float partedAtRest(const WorldData& world, const NearFeatures& near) {
  const SoftMeshData& mesh = *world.softs[near.first].mesh;
  const auto at = [&](uint32_t i) { return mesh.points()[i]; };
  Vec3 off;
  if (near.kind == TouchKind::EdgeEdge) {
    const auto &a = mesh.parts().features.edges[near.firstPart], &b = mesh.parts().features.edges[near.secondPart];
    off = nearestFeatures(near.kind, {at(a[0]), at(a[1]), at(b[0]), at(b[1])}).off;
  } else {
    const auto& face = mesh.surface()[near.secondPart];
    off = nearestFeatures(near.kind, {at(near.firstPart), at(face[0]), at(face[1]), at(face[2])}).off;
  }
  return length(off);
}

/// Whether a direction leads out of a solid at an edge.
bool leadsOut(const SoftSurfaces& s, const SoftData& soft, uint32_t slot, uint32_t edge, Vec3 direction) {
  if (soft.mesh->isCloth()) return true;
  const auto& faces = soft.mesh->parts().features.edgeFaces[edge];
  Vec3 out;
  for (const uint32_t face : faces)
    if (face != SurfaceFeatures::kNoFace) out = out + s.places[slot].normals[face];
  return dot(out, direction) > 0;
}

/// Whether two edges are nearest within both, and outside of solids.
bool edgesCount(const WorldData& world, const SoftSurfaces& surfaces, const NearFeatures& near,
                const NearestFeatures& nearest) {
  const auto isInner = [](float x) { return x > kEnd && x < 1 - kEnd; };
  return isInner(nearest.place.x) && isInner(nearest.place.y) &&
         leadsOut(surfaces, world.softs[near.second], near.second, near.secondPart, nearest.off) &&
         leadsOut(surfaces, world.softs[near.first], near.first, near.firstPart, -nearest.off);
}

/// How fast the second closes in along a direction, at most.
float closing(const NearFeatures& near, Vec3 direction) {
  return -leastApart(firstNodes(near.kind), [&](int i) { return dot(direction, near.points.way[i]); });
}

/// Cloth has no inside: what touched it from one side and is on the other one by now has passed.
bool hasPassed(const WorldData& world, const SoftTouch& touch, Vec3 off) {
  const SoftTouch* old = rememberedTouch(world, touch);
  return old && old->secondPart == touch.secondPart && dot(old->normal, off) < 0;
}

/// Two that are far apart for their size have rows only if they meet, and as they are then.
void meetLater(const WorldData& world, StepData& step, const NearFeatures& near) {
  const float time = meetingTime(world, step.softs, near);
  if (time > 1) return;
  const FoundTouch found = touchAt(world, near, time);
  if (mayTouchSoft(world, found.touch)) addTouch(world, step, found);
}

/// For the search behind the solve.
void noteContact(const WorldData& world, SoftSurfaces& surfaces, const NearFeatures& near,
                 const FeatureContact& contact) {
  if (!mayMeet(world, near, contact)) return;
  const Vec3 direction = contact.off * (1 / contact.distance);
  surfaces.contacts.push_back({near, direction, contact.distance});
}

void meet(const WorldData& world, StepData& step, const NearFeatures& near) {
  const FeatureContact contact = featureContact(world, step.softs, near);
  noteContact(world, step.softs, near, contact);
  float thickness = world.softs[near.first].radius + world.softs[near.second].radius;
  const float margin = touchMargin(world), size = world.softs[near.second].mesh->faceSize();
  if (contact.distance > thickness + margin + size) return meetLater(world, step, near);
  const bool point = near.kind == TouchKind::PointFace;
  if (point && !near.within() && !world.softs[near.second].mesh->isCloth()) return;  // soft_points.cpp
  if (!contact.counts) return;
  FoundTouch found;
  found.touch = near.touch();
  found.touch.anchor = contact.place;
  found.off = contact.off;
  if (contact.distance <= kNoDirection * thickness) return;
  const Vec3 direction = contact.off * (1 / contact.distance);
  const float way = closing(near, direction), reach = margin + std::min(way < 0 ? -way : way, size);
  if (contact.distance > thickness + reach) return;
  const bool passed = hasPassed(world, found.touch, contact.off);
  thickness = thicknessOf(world, near);
  found.touch.normal = passed ? -direction : direction;
  found.separation = (passed ? -contact.distance : contact.distance) - thickness;
  if (found.separation > margin + std::min(std::max(passed ? -way : way, 0.0f), size)) return;
  if (!mayTouchSoft(world, found.touch)) return;
  addTouch(world, step, found);
}

}  // namespace

float thicknessOf(const WorldData& world, const NearFeatures& near) {
  const float both = world.softs[near.first].radius + world.softs[near.second].radius;
  return near.within() ? std::min(both, kOfRest * partedAtRest(world, near)) : both;
}

NearestFeatures nearestFeatures(TouchKind kind, const Vec3 (&p)[4]) {
  if (kind == TouchKind::EdgeEdge) {
    const NearestOnEdges nearest = nearestOnEdges(p[0], p[1], p[2], p[3]);
    return {{nearest.onFirst, nearest.onSecond, 0}, nearest.first - nearest.second};
  }
  const NearestOnFace nearest = nearestOnFace(p[0], p[1], p[2], p[3]);
  return {nearest.weights, p[0] - nearest.point};
}

FeatureContact featureContact(const WorldData& world, const SoftSurfaces& surfaces, const NearFeatures& near) {
  const auto& p = near.points.at;
  const NearestFeatures nearest = nearestFeatures(near.kind, p);
  const bool counts = near.kind == TouchKind::EdgeEdge ? edgesCount(world, surfaces, near, nearest)
                                                       : world.softs[near.second].mesh->isCloth() ||
                                                             dot(cross(p[2] - p[1], p[3] - p[1]), nearest.off) > 0;
  return {nearest.place, nearest.off, length(nearest.off), counts};
}

void findFeatureTouches(const WorldData& world, StepData& step) {
  step.softs.contacts.clear();
  forEachNear(world, step.softs, [&](const NearFeatures& near) { meet(world, step, near); });
}

}  // namespace avbd
