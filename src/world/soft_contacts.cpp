// Contacts of surfaces of soft bodies as the user sees them (soft_contacts.h).
#include "world/soft_contacts.h"

#include <algorithm>

namespace avbd {

SoftPair softPair(const WorldData& data, uint32_t shapeA, uint32_t shapeB) {
  SoftPair pair;
  pair.key = thingPair(data, shapeA, shapeB);
  const uint32_t shape[2] = {shapeA, shapeB};
  for (int i = 0; i < 2; ++i) {
    const uint32_t body = data.shapes[shape[i]].body, soft = wholeOf(data, shape[i]);
    if (soft != kNone) pair.soft[i] = data.softIds.id(soft);
    pair.shape[i] = data.shapeIds.id(shape[i]);
    pair.body[i] = data.bodyIds.id(body);
  }
  return pair;
}

TouchPhase softPhase(const WorldData& data, uint32_t shapeA, uint32_t shapeB) {
  const uint64_t key = thingPair(data, shapeA, shapeB);
  const auto at = std::lower_bound(data.softPairs.begin(), data.softPairs.end(), key,
                                   [](const SoftPair& pair, uint64_t k) { return pair.key < k; });
  if (at == data.softPairs.end() || at->key != key) return TouchPhase::None;
  return at->begins ? TouchPhase::Begins : TouchPhase::Persists;
}

namespace {

/// Equal as long as the features are the same.
uint32_t nameOf(const SoftContact& contact) {
  return (contact.firstPart * 0x9e3779b1u) ^ contact.secondPart ^ (static_cast<uint32_t>(contact.kind) << 30);
}

}  // namespace

Contact contactOf(const WorldData& data, const SoftContact& from) {
  // A has the lower slot, as in pairs.
  const bool turned = from.shape[0] > from.shape[1];
  const uint32_t a = from.shape[turned ? 1 : 0], b = from.shape[turned ? 0 : 1];
  const SoftPair ids = softPair(data, a, b);
  Contact contact;
  contact.shapeA = ids.shape[0], contact.shapeB = ids.shape[1];
  contact.bodyA = ids.body[0], contact.bodyB = ids.body[1];
  contact.softA = ids.soft[0], contact.softB = ids.soft[1];
  if (from.kind != TouchKind::EdgeEdge) (turned ? contact.elementA : contact.elementB) = from.secondPart;
  contact.touch = softPhase(data, a, b);
  contact.normal = turned ? from.normal : -from.normal;
  contact.pointCount = 1;
  ContactPoint& point = contact.points[0];
  point = {};
  point.position = from.position;
  point.separation = from.separation;
  point.normalForce = from.normalForce;
  point.frictionForce = turned ? from.frictionForce : -from.frictionForce;
  point.feature = nameOf(from);
  return contact;
}

}  // namespace avbd
