// Snapshots: soft bodies. What they are made of is shared, and where they are their particles say.
#include <algorithm>

#include "geom/soft_mesh_parts.h"
#include "world/pairs.h"
#include "world/snapshot_parts.h"
#include "world/soft.h"

namespace avbd::snapshot {
namespace {

/// All members by name but mesh, bodies and memory, which are coded below.
template <class Codec, class Soft>
void codeNumbers(Codec& codec, Soft& soft) {
  auto& [mesh, material, radius, selfContact, bodies, userData, memory] = soft;
  codec.put(material.youngsModulus), codec.put(material.poissonRatio), codec.put(material.density);
  codec.put(material.thickness), codec.put(material.bending), codec.put(material.damping);
  codec.put(material.maxStrain), codec.put(material.warp);
  codec.put(material.weftModulus), codec.put(material.shearModulus), codec.put(material.model);
  codec.put(radius), codec.put(selfContact), codec.put(userData);
}

/// Every particle is one of its soft body and of no other.
void checkParticles(const WorldData& data) {
  size_t left = 0;
  data.bodyIds.forEach([&](uint32_t slot) { left += data.bodies[slot].soft != kNone; });
  data.softIds.forEach([&](uint32_t slot) {
    const SoftData& soft = data.softs[slot];
    require(soft.bodies.size() == soft.mesh->points().size(), "a soft body's points");
    std::vector<uint32_t> sorted = soft.bodies;
    std::sort(sorted.begin(), sorted.end());
    require(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end(), "a particle that stands for two points");
    for (const uint32_t body : soft.bodies) {
      require(data.bodyIds.isAliveSlot(body) && data.bodies[body].soft == slot && left > 0, "a soft body's particle");
      require(data.bodies[body].type == BodyType::Dynamic, "a particle that does not move");
      require(data.bodies[body].asleep == data.bodies[soft.bodies[0]].asleep, "a particle that sleeps alone");
      --left;
    }
  });
  require(left == 0, "a particle of no soft body");
}

size_t partsOf(const WorldData& data, const SoftTouch& touch, bool second) {
  const SoftData& soft = data.softs[second ? touch.second : touch.first];
  if (touch.kind == TouchKind::EdgeEdge) return soft.mesh->parts().features.edges.size();
  return second ? soft.mesh->surface().size() : soft.bodies.size();
}

void checkTouches(const WorldData& data) {
  const SoftTouch* before = nullptr;
  for (const SoftTouch& touch : data.softTouches) {
    const bool ofShape = touch.kind == TouchKind::ShapeFace;
    require(touch.kind <= TouchKind::ShapeFace && data.softIds.isAliveSlot(touch.second) &&
                (ofShape ? data.shapeIds.isAliveSlot(touch.first) : data.softIds.isAliveSlot(touch.first)),
            "a touch of soft bodies that there are not");
    require(touch.secondPart < partsOf(data, touch, true) && (ofShape || touch.firstPart < partsOf(data, touch, false)),
            "a touch of no point, edge or face");
    require(!before || *before < touch, "the order of touches");
    before = &touch;
  }
}

}  // namespace

void checkSoftContacts(const WorldData& data) {
  const SoftContact* before = nullptr;
  for (const SoftContact& contact : data.softContacts) {
    for (const uint32_t shape : contact.shape)
      require(shape < data.shapes.size() && (data.shapeIds.isAliveSlot(shape) || isForgotten(data, shape)),
              "a contact of a shape that there is not");
    require(contact.kind <= TouchKind::ShapeFace && (!before || *before < contact), "the order of contacts");
    before = &contact;
  }
  for (size_t i = 1; i < data.softPairs.size(); ++i)
    require(data.softPairs[i - 1].key < data.softPairs[i].key, "the order of what touches soft bodies");
}

void codeSofts(Writer& out, const WorldData& data, SharedTable& table) {
  data.softIds.forEach([&](uint32_t slot) {
    const SoftData& soft = data.softs[slot];
    out.put(table.number(soft.mesh));
    codeNumbers(out, soft);
    list(out, soft.bodies), list(out, soft.memory.pressures), list(out, soft.memory.tensions);
  });
  recordList(out, data.softTouches), recordList(out, data.softContacts), recordList(out, data.softPairs);
}

void codeSofts(Reader& in, WorldData& data, const KnownThings& things) {
  require(data.softIds.count() <= in.left(), "more soft bodies than bytes");
  data.softs.assign(data.softIds.slotCount(), {});
  data.softIds.forEach([&](uint32_t slot) {
    SoftData& soft = data.softs[slot];
    soft.mesh =
        std::get<std::shared_ptr<const SoftMeshData>>(things.thing(in.take<uint32_t>(), SharedTable::Kind::SoftMesh));
    codeNumbers(in, soft);
    require(soft.material.youngsModulus > 0 && soft.material.poissonRatio < 0.5f && soft.material.poissonRatio > -1,
            "a soft body's material");
    require(soft.material.model <= SolidModel::Corotational, "a soft body's model");
    list(in, soft.bodies), list(in, soft.memory.pressures), list(in, soft.memory.tensions);
    require(soft.memory.pressures.size() == pressuresOf(*soft.mesh, soft.material), "a soft body's pressures");
    require(soft.memory.tensions.size() == tensionsOf(*soft.mesh, soft.material), "a soft body's tensions");
  });
  checkParticles(data);
  recordList(in, data.softTouches), recordList(in, data.softContacts), recordList(in, data.softPairs);
  checkTouches(data);
}

}  // namespace avbd::snapshot
