// Contacts of the last step, read from the pairs, and touches of the surfaces of soft bodies.
#include "api/world_impl.h"
#include "step/contacts.h"
#include "world/measure.h"
#include "world/pairs.h"
#include "world/soft_touch.h"

namespace avbd {

std::vector<Contact> World::contacts() const {
  std::vector<Contact> contacts;
  getContacts(contacts);
  return contacts;
}

void World::getContacts(std::vector<Contact>& out) const {
  const WorldData& data = impl_->data;
  out.clear();
  const PairData* head = nullptr;
  forEachPair(data, [&](const PairData& pair) {
    if (pair.patch == 0) head = &pair;
    if (contactPoints(pair) > 0) out.push_back(contactOf(data, pair, *head));
  });
}

namespace {

SurfaceTouch surfaceTouchOf(const WorldData& data, const SoftTouch& touch) {
  SurfaceTouch out;
  out.soft = data.softIds.id(touch.second);
  if (touch.kind == TouchKind::ShapeFace) {
    out.shape = data.shapeIds.id(touch.first);
    out.body = data.bodyIds.id(data.shapes[touch.first].body);
  } else {
    out.other = data.softIds.id(touch.first);
  }
  const std::array<uint32_t, 4> nodes = nodesOf(data, touch);
  const std::array<float, 4> weights = nodeWeights(touch.kind, touch.anchor);
  for (size_t i = touch.kind == TouchKind::EdgeEdge ? 2 : 1; i < 4; ++i)
    out.position = out.position + data.bodies[nodes[i]].position * double{weights[i]};
  const TouchBasis basis = basisOf(touch.normal);
  out.normal = touch.normal;
  out.normalForce = touch.lambda.x;
  out.frictionForce = basis.t1 * touch.lambda.y + basis.t2 * touch.lambda.z;
  return out;
}

}  // namespace

std::vector<SurfaceTouch> World::surfaceTouches() const {
  std::vector<SurfaceTouch> touches;
  for (const SoftTouch& touch : impl_->data.softTouches)
    if (touch.lambda.x != 0) touches.push_back(surfaceTouchOf(impl_->data, touch));
  return touches;
}

}  // namespace avbd
