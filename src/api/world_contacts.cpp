// Contacts of the last step, read from the pairs.
#include "api/world_impl.h"
#include "world/measure.h"
#include "world/pairs.h"

namespace avbd {

std::vector<Contact> World::contacts() const {
  const WorldData& data = impl_->data;
  std::vector<Contact> contacts;
  forEachPair(data, [&](const PairData& pair) {
    if (pair.manifold.count > 0) contacts.push_back(contactOf(data, pair));
  });
  return contacts;
}

}  // namespace avbd
