// Contacts of the last step, read from the pairs and the touches of soft bodies.
#include "api/world_impl.h"
#include "world/measure.h"
#include "world/pairs.h"
#include "world/soft_contacts.h"

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
  for (const SoftContact& contact : data.softContacts)
    if (data.forgotten.empty() || (!isForgotten(data, contact.shape[0]) && !isForgotten(data, contact.shape[1])))
      out.push_back(contactOf(data, contact));
}

}  // namespace avbd
