// Snapshots: joints, with what those of some types have besides.
#include <algorithm>

#include "world/joints.h"
#include "world/snapshot_parts.h"

namespace avbd::snapshot {
namespace {

constexpr size_t kMostNumbers = 64;  ///< of constants and of memory

/// The records that the next ones are coded against.
struct Expected {
  JointData joint;
  D6Data d6;
  LinkData link;
};

void codeFamily(Writer& out, const LinkData& link, SharedTable& table) { out.put(table.number(link.family)); }

void codeFamily(Reader& in, LinkData& link, const KnownThings& things) {
  link.family =
      std::get<std::shared_ptr<const CustomFamily>>(things.thing(in.take<uint32_t>(), SharedTable::Kind::Family));
  require(link.constants.size() <= kMostNumbers && link.memory.size() <= kMostNumbers, "too many numbers of a joint");
}

template <class Codec, class Link, class Things>
void codeLink(Codec& codec, JointType type, Link& link, const LinkData& expected, Things& things) {
  codec.record(link, expected);
  if (type == JointType::Coupling) recordList(codec, link.terms);
  if (type != JointType::Custom) return;
  list(codec, link.constants);
  list(codec, link.memory);
  codeFamily(codec, link, things);
}

template <class Codec, class World, class Things>
void codeOne(Codec& codec, World& data, uint32_t slot, Expected& expected, Things& things) {
  auto& joint = data.joints[slot];
  codec.record(joint, expected.joint);
  expected.joint = joint;
  if constexpr (Codec::kReads) {
    require(joint.type <= JointType::Custom, "a joint of no type");
    require(!isD6(joint.type) || slot < data.d6.size(), "a joint without its coordinates");
    require(!isLink(joint.type) || slot < data.links.size(), "a joint without its link");
  }
  if (isD6(joint.type)) {
    codec.record(data.d6[slot], expected.d6);
    expected.d6 = data.d6[slot];
  }
  if (isLink(joint.type)) {
    codeLink(codec, joint.type, data.links[slot], expected.link, things);
    copyFields(expected.link, data.links[slot]);
  }
}

template <class Codec, class World, class Things>
void codeAll(Codec& codec, World& data, Things& things) {
  Expected expected;
  data.jointIds.forEach([&](uint32_t slot) { codeOne(codec, data, slot, expected, things); });
}

/// What follows from the joints.
void count(WorldData& data) {
  data.couplings.clear();
  data.breakable = 0;
  data.jointIds.forEach([&](uint32_t slot) {
    if (data.joints[slot].type == JointType::Coupling) data.couplings.push_back(slot);
    data.breakable += isBreakable(data.joints[slot].breaks);
  });
}

}  // namespace

void codeJoints(Writer& out, const WorldData& data, SharedTable& table) {
  out.number(data.d6.size());
  out.number(data.links.size());
  out.put(data.jointForces);
  codeAll(out, data, table);
}

void codeJoints(Reader& in, WorldData& data, const KnownThings& things) {
  const size_t slots = data.jointIds.slotCount();
  require(data.jointIds.count() <= in.left(), "more joints than bytes");
  const uint64_t d6 = in.number(), links = in.number();
  require(d6 <= slots && links <= slots, "more coordinates than joints");
  data.joints.resize(slots);
  data.d6.assign(d6, {});
  data.links.resize(links);
  for (LinkData& link : data.links) {
    link.terms.clear(), link.constants.clear(), link.memory.clear();
    link.family.reset();
    copyFields(link, LinkData{});
  }
  for (uint32_t slot = 0; slot < slots; ++slot)
    if (!data.jointIds.isAliveSlot(slot)) data.joints[slot] = {};
  in.put(data.jointForces);
  codeAll(in, data, things);
  count(data);
}

}  // namespace avbd::snapshot
