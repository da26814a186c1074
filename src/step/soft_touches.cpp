// Touches of soft bodies: all searches, and what touches remember (soft_touches.h).
#include "step/soft_touches.h"

#include <algorithm>

#include "step/contacts.h"
#include "world/pairs.h"
#include "world/soft_touch.h"

namespace avbd {

bool sleeps(const WorldData& world, const SoftTouch& touch) {
  return world.bodies[bodyOfFirst(world, touch)].asleep && world.bodies[bodyOfSecond(world, touch)].asleep;
}

bool mayTouchSoft(const WorldData& world, const SoftTouch& touch) {
  const auto [a, b] = shapesOf(world, touch);
  if (a == kNone || b == kNone) return false;
  if (touch.kind != TouchKind::ShapeFace && touch.first == touch.second) return true;
  if (!filtersMeet(world.shapes[a].filter, world.shapes[b].filter)) return false;
  if (world.excludedPairs.empty()) return true;
  const std::array<uint32_t, 4> nodes = nodesOf(world, touch);
  const auto split = static_cast<size_t>(firstNodes(touch.kind));
  for (size_t i = 0; i < split; ++i)
    for (size_t k = split; k < 4; ++k)
      if (isExcluded(world, nodes[i], nodes[k])) return false;
  return true;
}

const SoftTouch* rememberedTouch(const WorldData& world, const SoftTouch& touch) {
  const auto& all = world.softTouches;
  const auto same = std::lower_bound(all.begin(), all.end(), touch);
  if (same != all.end() && !(touch < *same)) return &*same;
  if (touch.kind != TouchKind::PointFace) return nullptr;
  // A point slides from face to face.
  SoftTouch key = touch;
  key.secondPart = 0;
  const SoftTouch* best = nullptr;
  for (auto old = std::lower_bound(all.begin(), all.end(), key); old != all.end(); ++old) {
    if (old->kind != key.kind || old->first != key.first || old->firstPart != key.firstPart ||
        old->second != key.second)
      break;
    if (!best || dot(old->normal, touch.normal) > dot(best->normal, touch.normal)) best = &*old;
  }
  return best;
}

namespace {

/// Multipliers, and the place of sticking while the features are the same.
void remember(const WorldData& world, SoftTouch& touch) {
  const SoftTouch* old = rememberedTouch(world, touch);
  if (!old || dot(old->normal, touch.normal) <= kSameNormal) return;
  const TouchBasis before = basisOf(old->normal), now = basisOf(touch.normal);
  const Vec3 tangential = before.t1 * old->lambda.y + before.t2 * old->lambda.z;
  touch.lambda = {old->lambda.x, dot(tangential, now.t1), dot(tangential, now.t2)};
  touch.sticks = old->sticks, touch.slides = old->slides;
  if (old->secondPart == touch.secondPart && old->sticks) touch.anchor = old->anchor, touch.place = old->place;
}

constexpr float kSamePlace = 1e-3f;  ///< of the distance

/// The same point before faces that share the place: one of them is enough. `all` is ascending.
void dropSame(std::vector<FoundTouch>& all) {
  const auto isSame = [](const FoundTouch& a, const FoundTouch& b) {
    const Vec3 off = a.off - b.off;
    return a.touch.kind == TouchKind::PointFace && b.touch.kind == a.touch.kind && a.touch.first == b.touch.first &&
           a.touch.firstPart == b.touch.firstPart && a.touch.second == b.touch.second &&
           dot(off, off) < kSamePlace * kSamePlace * dot(a.off, a.off);
  };
  size_t kept = 0, begin = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    while (begin < kept &&
           (all[begin].touch.first != all[i].touch.first || all[begin].touch.firstPart != all[i].touch.firstPart))
      ++begin;
    bool same = false;
    for (size_t k = begin; k < kept && !same; ++k) same = isSame(all[k], all[i]) || !(all[k].touch < all[i].touch);
    if (!same) all[kept++] = all[i];
  }
  all.resize(kept);
}

}  // namespace

namespace {

/// False of NaN: features that are too long for floats (1e10 m and more) have no nearest points.
bool hasPlace(const FoundTouch& found) {
  const Vec3 normal = found.touch.normal, place = found.touch.anchor;
  return dot(normal, normal) > 0.5f && dot(place, place) < 1e30f && found.separation < 1e30f;
}

}  // namespace

void addTouch(const WorldData& world, StepData& step, FoundTouch found) {
  if (!hasPlace(found)) return;
  found.weights = nodeWeights(found.touch.kind, found.touch.anchor);
  found.awake = true;
  remember(world, found.touch);
  step.softTouches.push_back(found);
}

void findSoftTouches(const WorldData& world, StepData& step) {
  step.softTouches.clear();
  for (const SoftTouch& touch : world.softTouches)
    if (sleeps(world, touch)) {
      step.softTouches.emplace_back();
      step.softTouches.back().touch = touch;
    }
  if (world.softIds.count() == 0) return;
  if (!world.sleep.awake.empty()) {
    placeSofts(world, step);
    findNearFaces(world, step.softs);
    findPointTouches(world, step);
    findFeatureTouches(world, step);
    findShapeTouches(world, step);
  }
  std::sort(step.softTouches.begin(), step.softTouches.end(),
            [](const FoundTouch& a, const FoundTouch& b) { return a.touch < b.touch; });
  dropSame(step.softTouches);
}

}  // namespace avbd
