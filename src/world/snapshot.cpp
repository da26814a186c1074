// Snapshots of a whole world (snapshot.h).
//
// Head, 40 bytes: "AVBDSNAP", version (u32), 0 (u32), size of the whole (u64), fingerprint of the world (u64), hash of
// all that and of what follows (u64). Then: things that are shared, settings, ids, bodies, shapes and tree, joints,
// lists, pairs, what sleeps, what was lost, events.
#include "world/snapshot.h"

#include <avbd/error.h>
#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>

#include <algorithm>
#include <string>

#include "base/format.h"
#include "base/hash.h"
#include "world/check.h"
#include "world/joints.h"
#include "world/limits.h"
#include "world/snapshot_parts.h"

namespace avbd {
namespace snapshot {
namespace {

constexpr char kMagic[8] = {'A', 'V', 'B', 'D', 'S', 'N', 'A', 'P'};
constexpr size_t kHead = 40, kHashAt = 32;

[[noreturn]] void refuse(std::string value, std::string range) {
  (Path("World::restore") / "snapshot").refuse(std::move(value), std::move(range));
}

/// Of what a world was made with and cannot change. What changes no bit of a result is left out.
uint64_t fingerprint(const WorldDef& def) {
  auto& [gravity, workers, iterations, substeps, lengthUnit, restitutionThreshold, maxDepenetrationSpeed, hitSpeed,
         moveEvents, continuous, continuousJointed, primalSolver, krylovIterations, jointArmBlend, sleep, sleepTime,
         sleepSpeed, simdWidth, tasks] = def;
  Hash64 hash;
  hash.value(lengthUnit);
  hash.value(restitutionThreshold);
  hash.value(maxDepenetrationSpeed);
  hash.value(hitSpeed);
  hash.value(static_cast<uint8_t>(moveEvents));
  hash.value(static_cast<uint8_t>(primalSolver));
  hash.value(static_cast<int32_t>(krylovIterations));
  hash.value(jointArmBlend);
  hash.value(static_cast<uint8_t>(continuous));
  hash.value(static_cast<uint8_t>(continuousJointed));
  hash.value(static_cast<uint8_t>(sleep));
  hash.value(sleepTime);
  hash.value(sleepSpeed);
  return hash.digest();
}

uint64_t hashOf(std::span<const std::byte> whole) {
  Hash64 hash;
  hash.bytes(whole.data(), kHashAt);
  hash.bytes(whole.data() + kHead, whole.size() - kHead);
  return hash.digest();
}

void codeThings(Writer& out, const SharedTable& table) {
  out.number(table.entries().size());
  for (const SharedTable::Entry& entry : table.entries()) out.put(entry.kind()), out.put(entry.hash);
}

void codeThings(Reader& in, KnownThings& things) {
  const size_t count = in.count(sizeof(uint8_t) + sizeof(uint64_t));
  for (uint32_t i = 0; i < count; ++i) {
    const auto kind = in.take<SharedTable::Kind>();
    require(kind <= SharedTable::Kind::SoftMesh, "a thing of no kind");
    things.entryOf.push_back(things.table.find(kind, in.take<uint64_t>(), i));
  }
}

/// Settings and figures of the world itself, and the lists that are plain numbers or records.
template <class Codec, class World>
void codeWorld(Codec& codec, World& data) {
  codec.put(data.def.gravity);
  codec.put(data.def.iterations);
  codec.put(data.def.substeps);
  codec.put(data.time);
  codec.put(data.lastSubstep);
  codec.put(data.treeBehind);
  codec.put(data.wishesChanged);
  codec.record(data.report, StepReport{});
}

template <class Codec, class World>
void codeLists(Codec& codec, World& data) {
  list(codec, data.excludedPairs);
  list(codec, data.unpaired);
  list(codec, data.forgotten);
}

template <class Codec, class World>
void codeEvents(Codec& codec, World& data) {
  recordList(codec, data.lostTouches);
  auto& [begins, ends, enters, leaves, hits, breaks, moves, sleeps, wakes] = data.events;
  recordList(codec, begins), recordList(codec, ends);
  recordList(codec, enters), recordList(codec, leaves);
  recordList(codec, hits), recordList(codec, breaks), recordList(codec, moves);
  list(codec, sleeps), list(codec, wakes);
}

template <class Tag>
void codeIds(Writer& out, const HandlePool<Tag>& pool) {
  out.number(pool.slotCount());
  for (const uint32_t generation : pool.generations()) out.number(generation);
  list(out, pool.freeSlots());
}

template <class Tag>
void codeIds(Reader& in, HandlePool<Tag>& pool) {
  std::vector<uint32_t> generations, freeSlots;
  generations.resize(in.count(1));
  for (uint32_t& generation : generations) {
    const uint64_t n = in.number();
    require(n <= 0xffffffffu, "a generation beyond the last");
    generation = static_cast<uint32_t>(n);
  }
  list(in, freeSlots);
  require(pool.restore(generations, freeSlots), "ids that are none");
}

/// Whether the steps to come call a contact hook.
bool asksHook(const WorldData& data) { return data.contactHook && data.hookedShapes > 0; }

void checkHook(bool asked, const WorldData& restored, const WorldData& world) {
  const bool asks = world.contactHook && restored.hookedShapes > 0;
  if (asked && !asks) refuse("of a world with a contact hook", "must be restored where there is one (setContactHook)");
  if (!asked && asks)
    refuse("of a world without contact hook", "must be restored where there is none (setContactHook)");
}

/// All members by name: a new one does not compile before it is here, and in codeWorld() or another section if it is
/// state.
void allMembers(WorldData& data) {
  [[maybe_unused]] auto& [def, bodyIds, shapeIds, jointIds, softIds, bodies, shapes, joints, d6, links, softs,
                          softTouches, softContacts, softPairs, couplings, jointForces, breakable, pairs, excludedPairs,
                          tree, unpaired, forgotten, treeBehind, time, lastSubstep, report, means, events, lostTouches,
                          contactHook, hookedShapes, sleep, wishesChanged] = data;
}

void read(Reader& in, const WorldData& world, SharedTable& table, PairSides& sides, WorldData& out) {
  allMembers(out);
  KnownThings things{table, {}};
  numberThings(world, table);
  codeThings(in, things);
  out.def = world.def;
  out.report = world.report;
  const bool asked = in.take<bool>();
  codeWorld(in, out);
  require(out.def.iterations >= 1 && out.def.iterations <= kMaxIterations, "iterations");
  require(out.def.substeps >= 1 && out.def.substeps <= 1000, "substeps");
  codeIds(in, out.bodyIds), codeIds(in, out.shapeIds), codeIds(in, out.jointIds), codeIds(in, out.softIds);
  codeBodies(in, out);
  codeShapes(in, out, things);
  checkHook(asked, out, world);
  codeJoints(in, out, things);
  codeSofts(in, out, things);
  codeLists(in, out);
  checkLinks(out);
  checkSoftContacts(out);
  fillSides(out, sides);
  codePairs(in, out, sides);
  codeSleep(in, out, sides);
  checkSleep(out);
  codeEvents(in, out);
  for (const LostTouch& lost : out.lostTouches) require(lost.wasTouching, "a touch that never was");
  require(in.left() == 0, "more than it says");
}

}  // namespace

const SharedTable::Thing& KnownThings::thing(uint32_t number, SharedTable::Kind kind) const {
  require(number < entryOf.size(), "a thing that it does not name");
  if (entryOf[number] == SharedTable::kUnknown)
    refuse("of another world", std::string("must name a ") + kindName(kind) + " that this world has or had");
  const SharedTable::Entry& entry = table.entries()[entryOf[number]];
  require(entry.kind() == kind, "a thing of another kind");
  return entry.thing;
}

void numberThings(const WorldData& data, SharedTable& table) {
  data.shapeIds.forEach([&](uint32_t slot) {
    const Geometry& geometry = data.shapes[slot].geometry;
    if (const Hull* hull = std::get_if<Hull>(&geometry)) table.number(hull->data);
    if (const Mesh* mesh = std::get_if<Mesh>(&geometry)) table.number(mesh->data);
    if (const HeightField* field = std::get_if<HeightField>(&geometry)) table.number(field->data);
  });
  data.jointIds.forEach([&](uint32_t slot) {
    if (data.joints[slot].type == JointType::Custom) table.number(data.links[slot].family);
  });
  data.softIds.forEach([&](uint32_t slot) { table.number(data.softs[slot].mesh); });
}

}  // namespace snapshot

void saveSnapshot(const WorldData& data, SharedTable& table, snapshot::PairSides& sides, snapshot::Writer& out) {
  using namespace snapshot;
  constexpr std::array<std::byte, kHead> kEmpty{};
  out.raw(kEmpty.data(), kHead);
  numberThings(data, table);
  codeThings(out, table);
  out.put(asksHook(data));
  codeWorld(out, data);
  codeIds(out, data.bodyIds), codeIds(out, data.shapeIds), codeIds(out, data.jointIds), codeIds(out, data.softIds);
  codeBodies(out, data);
  codeShapes(out, data, table);
  codeJoints(out, data, table);
  codeSofts(out, data, table);
  codeLists(out, data);
  fillSides(data, sides);
  codePairs(out, data, sides);
  codeSleep(out, data, sides);
  codeEvents(out, data);
}

void sealSnapshot(const WorldData& data, std::span<std::byte> whole) {
  using namespace snapshot;
  const auto set = [&](size_t at, const auto& value) { std::memcpy(whole.data() + at, &value, sizeof(value)); };
  set(0, kMagic);
  set(8, kSnapshotVersion);
  set(16, static_cast<uint64_t>(whole.size()));
  set(24, fingerprint(data.def));
  set(kHashAt, hashOf(whole));
}

void loadSnapshot(std::span<const std::byte> whole, const WorldData& world, SharedTable& table,
                  snapshot::PairSides& sides, WorldData& out) {
  using namespace snapshot;
  const auto get = [&](size_t at, auto value) {
    std::memcpy(&value, whole.data() + at, sizeof(value));
    return value;
  };
  if (whole.empty()) refuse("empty", "must be a snapshot");
  if (whole.size() < kHead) refuse(toText(whole.size()) + " bytes", "must be a whole snapshot: it is cut short");
  if (std::memcmp(whole.data(), kMagic, sizeof(kMagic)) != 0) refuse("no snapshot", "must be one of World::save()");
  const auto version = get(8, uint32_t{});
  if (version != kSnapshotVersion) refuse("version " + toText(version), "must be version " + toText(kSnapshotVersion));
  const auto size = get(16, uint64_t{});
  if (size > whole.size()) refuse(toText(whole.size()) + " bytes", "must be a whole snapshot: it is cut short");
  if (size < whole.size()) refuse(toText(whole.size()) + " bytes", "must be as long as it was saved: " + toText(size));
  if (get(kHashAt, uint64_t{}) != hashOf(whole)) refuse("damaged", "must be as it was saved: its hash is another");
  if (get(24, uint64_t{}) != fingerprint(world.def))
    refuse("of another world", "must be of this one, or of one that was made with an equal WorldDef");
  try {
    Reader in(whole.subspan(kHead));
    read(in, world, table, sides, out);
  } catch (const Unsound& found) {
    refuse("unsound", std::string("must hold a world: ") + found.what);
  }
}

}  // namespace avbd
