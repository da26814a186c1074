// Contacts of the last step, read from the pairs.
#include "api/world_impl.h"
#include "world/measure.h"
#include "world/pairs.h"

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

}  // namespace avbd
