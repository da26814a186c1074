// Publication of touches of soft bodies: what they remember, and their contacts as the user sees them.
#include <algorithm>

#include "step/begin_rows.h"
#include "step/contacts.h"
#include "step/soft_events.h"
#include "step/soft_touches.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

SoftContact named(const SoftTouch& touch) {
  SoftContact contact;
  contact.kind = touch.kind;
  contact.first = touch.first, contact.firstPart = touch.firstPart;
  contact.second = touch.second, contact.secondPart = touch.secondPart;
  return contact;
}

/// Of the nodes begin .. end - 1, the nearest one that has a shape.
uint32_t nearestShape(const WorldData& world, const FoundTouch& found, size_t begin, size_t end) {
  const std::array<uint32_t, 4> nodes = nodesOf(world, found.touch);
  uint32_t nearest = kNone;
  float most = -1;
  for (size_t i = begin; i < end; ++i) {
    const uint32_t shape = world.bodies[nodes[i]].firstShape;
    const float weight = found.weights[i] < 0 ? -found.weights[i] : found.weights[i];
    if (shape != kNone && weight > most) nearest = shape, most = weight;
  }
  return nearest;
}

/// While bodies are where they were when the substep began.
Vec3d placeOf(const WorldData& world, const FoundTouch& found) {
  const SoftTouch& touch = found.touch;
  const std::array<uint32_t, 4> nodes = nodesOf(world, touch);
  const Vec3d base = world.bodies[nodes[0]].position;
  const bool ofShape = touch.kind == TouchKind::ShapeFace;
  const auto split = static_cast<size_t>(firstNodes(touch.kind));
  Vec3 first = ofShape ? found.arm : Vec3{}, second;
  for (size_t i = 0; i < 4; ++i) {
    const Vec3 part = toFloat(world.bodies[nodes[i]].position - base) * found.weights[i];
    if (i < split)
      first = first - part;
    else
      second = second + part;
  }
  const float thicker = world.softs[touch.second].radius - (ofShape ? 0 : world.softs[touch.first].radius);
  return base + (first + second + touch.normal * thicker) * 0.5f;
}

SoftContact contactOf(const WorldData& world, const FoundTouch& found, Vec3 lambda, float share) {
  const SoftTouch& touch = found.touch;
  const TouchBasis basis = basisOf(touch.normal);
  const auto split = static_cast<size_t>(firstNodes(touch.kind));
  SoftContact contact = named(touch);
  contact.shape[0] = touch.kind == TouchKind::ShapeFace ? touch.first : nearestShape(world, found, 0, split);
  contact.shape[1] = nearestShape(world, found, split, 4);
  contact.position = placeOf(world, found);
  contact.normal = touch.normal;
  contact.separation = found.separation;
  contact.normalForce = lambda.x * share;
  contact.frictionForce = (basis.t1 * lambda.y + basis.t2 * lambda.z) * share;
  return contact;
}

/// Two lists, both ascending: of what is in both, the place of the later one with the forces of both.
void addContacts(const std::vector<SoftContact>& before, const std::vector<SoftContact>& later,
                 std::vector<SoftContact>& all) {
  all.clear();
  auto old = before.begin();
  for (const SoftContact& contact : later) {
    for (; old != before.end() && *old < contact; ++old) all.push_back(*old);
    all.push_back(contact);
    if (old == before.end() || contact < *old) continue;
    if (contact.shape[0] == kNone) all.back() = *old;
    if (contact.shape[0] != kNone) {
      all.back().normalForce += old->normalForce;
      all.back().frictionForce = contact.frictionForce + old->frictionForce;
    }
    ++old;
  }
  all.insert(all.end(), old, before.end());
}

/// What sleeps is as it was.
void recallSleepers(const WorldData& world, std::vector<SoftContact>& all) {
  size_t kept = 0;
  for (SoftContact contact : all) {
    if (contact.shape[0] == kNone) {
      const auto old = std::lower_bound(world.softContacts.begin(), world.softContacts.end(), contact);
      if (old == world.softContacts.end() || contact < *old) continue;
      contact = *old;
    }
    all[kept++] = contact;
  }
  all.resize(kept);
}

void publishContacts(WorldData& world, StepData& step) {
  if (step.substep == 0) {
    step.softContacts.swap(step.newSoftContacts);
  } else {
    addContacts(step.softContacts, step.newSoftContacts, step.mergedSoftContacts);
    step.softContacts.swap(step.mergedSoftContacts);
  }
  if (step.substep + 1 < world.def.substeps) return;
  recallSleepers(world, step.softContacts);
  world.softContacts.swap(step.softContacts);
}

}  // namespace

void publishSoftTouches(WorldData& world, StepData& step) {
  const size_t count = step.softTouches.size();
  world.softTouches.resize(count);
  step.newSoftContacts.resize(count);
  for (size_t i = 0; i < count; ++i) {
    world.softTouches[i] = step.softTouches[i].touch;
    step.newSoftContacts[i] = named(step.softTouches[i].touch);
  }
  const float share = 1 / static_cast<float>(world.def.substeps);
  step.jobs->forRange(static_cast<uint32_t>(step.touchLane.size()), 512, [&](uint32_t begin, uint32_t end, int) {
    for (size_t lane = begin; lane < end; ++lane) {
      const uint32_t index = step.touchLane[lane];
      if (index == kNone) continue;
      const rows::NodeContact<float> c = step.touchTiles[lane / kTile].get(static_cast<int>(lane % kTile));
      SoftTouch& touch = world.softTouches[index];
      touch.lambda = {c.lambdaN, c.lambda1, c.lambda2};
      touch.sticks = insideCone(touch.lambda, c.mu) ? 1 : 0;
      touch.slides = touch.sticks ? uint8_t{0} : static_cast<uint8_t>(std::min(touch.slides + 1, 255));
      step.newSoftContacts[index] = contactOf(world, step.softTouches[index], touch.lambda, share);
    }
  });
  noteSoftTouches(world, step);
  publishContacts(world, step);
}

}  // namespace avbd
