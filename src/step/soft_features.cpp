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

Vec3 restOf(const WorldData& world, const NearFeatures& near, uint32_t point) {
  return world.softs[near.first].mesh->points()[point];
}

float partedAtRest(const WorldData& world, const NearFeatures& near) {
  const SoftMeshData& mesh = *world.softs[near.first].mesh;
  const auto at = [&](uint32_t i) { return mesh.points()[i]; };
  if (near.kind == TouchKind::EdgeEdge) {
    const auto &a = mesh.parts().features.edges[near.firstPart], &b = mesh.parts().features.edges[near.secondPart];
    const NearestOnEdges nearest = nearestOnEdges(at(a[0]), at(a[1]), at(b[0]), at(b[1]));
    return length(nearest.first - nearest.second);
  }
  const auto& face = mesh.surface()[near.secondPart];
  const Vec3 p = restOf(world, near, near.firstPart);
  return length(p - nearestOnFace(p, at(face[0]), at(face[1]), at(face[2])).point);
}

/// Whether a direction leads out of a solid at an edge.
bool leadsOut(const SoftSurfaces& s, const SoftData& soft, uint32_t slot, uint32_t edge, Vec3 direction) {
  if (soft.mesh->isCloth()) return true;
  const auto& faces = soft.mesh->parts().features.edgeFaces[edge];
  Vec3 out;
  for (const uint32_t face : faces)
    if (face != SurfaceFeatures::kNoFace) {
      const Vec3 n = s.places[slot].normals[face];
      const float size = length(n);
      if (size > 0) out = out + n * (1 / size);
    }
  return dot(out, direction) > 0;
}

FeatureContact edgeContact(const WorldData& world, const SoftSurfaces& surfaces, const NearFeatures& near) {
  const auto& p = near.points.at;
  const NearestOnEdges nearest = nearestOnEdges(p[0], p[1], p[2], p[3]);
  FeatureContact contact;
  contact.place = {nearest.onFirst, nearest.onSecond, 0};
  contact.off = nearest.first - nearest.second;
  contact.distance = length(contact.off);
  const auto isInner = [](float x) { return x > kEnd && x < 1 - kEnd; };
  contact.counts = isInner(nearest.onFirst) && isInner(nearest.onSecond) &&
                   leadsOut(surfaces, world.softs[near.second], near.second, near.secondPart, contact.off) &&
                   leadsOut(surfaces, world.softs[near.first], near.first, near.firstPart, -contact.off);
  return contact;
}

/// How fast the second closes in along a direction, at most.
float closing(const NearFeatures& near, Vec3 direction) {
  const int split = near.kind == TouchKind::EdgeEdge ? 2 : 1;
  float first = 1e30f, second = -1e30f;
  for (int i = 0; i < 4; ++i) {
    const float along = dot(direction, near.points.way[i]);
    if (i < split)
      first = std::min(first, along);
    else
      second = std::max(second, along);
  }
  return second - first;
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
  surfaces.contacts.push_back(
      {near.kind, near.first, near.firstPart, near.second, near.secondPart, direction, contact.distance});
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
  found.touch.kind = near.kind;
  found.touch.first = near.first, found.touch.firstPart = near.firstPart;
  found.touch.second = near.second, found.touch.secondPart = near.secondPart;
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

FeatureContact featureContact(const WorldData& world, const SoftSurfaces& surfaces, const NearFeatures& near) {
  if (near.kind == TouchKind::EdgeEdge) return edgeContact(world, surfaces, near);
  const auto& p = near.points.at;
  const NearestOnFace nearest = nearestOnFace(p[0], p[1], p[2], p[3]);
  FeatureContact contact;
  contact.place = nearest.weights;
  contact.off = p[0] - nearest.point;
  contact.distance = length(contact.off);
  contact.counts = world.softs[near.second].mesh->isCloth() || dot(cross(p[2] - p[1], p[3] - p[1]), contact.off) > 0;
  return contact;
}

void findFeatureTouches(const WorldData& world, StepData& step) {
  step.softs.contacts.clear();
  forEachNear(world, step.softs, [&](const NearFeatures& near) { meet(world, step, near); });
}

}  // namespace avbd
