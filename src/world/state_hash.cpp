// Field by field, so that no padding is hashed (state_hash.h).
#include "world/state_hash.h"

#include "world/joints.h"
#include "world/pairs.h"

namespace avbd {

void addMultipliers(Hash64& hash, const JointMultipliers& l) {
  const float all[] = {l.lock, l.lower, l.upper, l.drive, l.friction, l.passive};
  hash.value(all);
}

namespace {

void add(Hash64& hash, const BodyData& body) {
  hash.value(body.position);
  hash.value(body.rotation);
  hash.value(body.linearVelocity);
  hash.value(body.angularVelocity);
  hash.value(body.force);
  hash.value(body.torque);
}

/// Which bodies sleep together, by the lowest of them, and how long the others have rested. Nothing where none sleeps.
void addSleep(Hash64& hash, const WorldData& data, const BodyData& body) {
  if (body.type != BodyType::Dynamic || (!data.def.sleep && !body.asleep)) return;
  hash.value(body.asleep ? data.sleep.islands[body.sleepIsland].bodies[0] + 1 : 0u);
  hash.value(body.stillTime);
}

void add(Hash64& hash, const D6Data& d6) {
  hash.value(d6.twist);
  hash.value(static_cast<uint8_t>(d6.twistKnown));
  for (const JointMultipliers& l : d6.lambda) addMultipliers(hash, l);
  hash.value(d6.force);
  hash.value(d6.coneLambda);
  hash.value(d6.slerpLambda);
}

void add(Hash64& hash, const LinkData& link) {
  addMultipliers(hash, link.lambda);
  hash.value(link.force);
  for (const float x : link.memory) hash.value(x);
}

void add(Hash64& hash, const PointMemory& point) {
  hash.value(point.feature);
  hash.value(point.lambda);
  hash.value(point.anchorA);
  hash.value(point.anchorB);
  hash.value(point.rebound);
  hash.value(point.impact);
  hash.value(point.sticks);
}

void add(Hash64& hash, const KeptManifold& kept) {
  hash.value(keepsPoints(kept) ? kept.what : KeptManifold::What::Nothing);
  if (!keepsPoints(kept)) return;
  hash.value(static_cast<uint8_t>(kept.aroundBase));
  hash.value(kept.offset);
  hash.value(kept.turn);
  hash.value(kept.clear);
  hash.value(kept.reach);
  hash.value(kept.normal);
  hash.value(kept.x);
  hash.value(kept.y);
  hash.value(kept.z);
  hash.value(kept.height);
}

void add(Hash64& hash, const PairData& pair) {
  hash.value(pair.key());
  // What most pairs do not have.
  if (pair.hasSurface) {
    hash.value(pair.patch);
    hash.value(pair.material);
    hash.value(pair.element);
  }
  if (pair.isTrigger) hash.value(static_cast<uint8_t>(pair.wasTouching));
  if (pair.torsionalFriction > 0 || pair.rollingFriction > 0) {
    hash.value(pair.turn);
    hash.value(pair.torque);
  }
  hash.value(pair.pointCount);
  if (!pair.hasContact()) return;
  hash.value(pair.normal);
  hash.value(pair.t1);
  hash.value(pair.t2);
  hash.value(pair.slides);
  hash.value(static_cast<uint8_t>(pair.landedSliding));
  for (int i = 0; i < pair.pointCount; ++i) add(hash, pair.points[i]);
  add(hash, pair.kept);
}

void add(Hash64& hash, const SoftTouch& touch) {
  hash.value(static_cast<uint8_t>(touch.kind)), hash.value(touch.sticks), hash.value(touch.slides);
  hash.value(touch.first), hash.value(touch.firstPart), hash.value(touch.second), hash.value(touch.secondPart);
  hash.value(touch.normal), hash.value(touch.lambda), hash.value(touch.anchor), hash.value(touch.place);
}

template <class Tag>
void addIds(Hash64& hash, const HandlePool<Tag>& pool) {
  hash.value(static_cast<uint64_t>(pool.count()));
  hash.value(static_cast<uint64_t>(pool.slotCount()));
  for (uint32_t slot = 0; slot < pool.slotCount(); ++slot) hash.value(pool.id(slot).generation);
}

}  // namespace

uint64_t stateHash(const WorldData& data) {
  Hash64 hash;
  addIds(hash, data.bodyIds);
  addIds(hash, data.shapeIds);
  addIds(hash, data.jointIds);
  data.bodyIds.forEach([&](uint32_t slot) {
    hash.value(slot);
    add(hash, data.bodies[slot]);
    addSleep(hash, data, data.bodies[slot]);
  });
  data.jointIds.forEach([&](uint32_t slot) {
    hash.value(slot);
    hash.value(data.joints[slot].lambda);
    hash.value(static_cast<uint8_t>(data.joints[slot].enabled | data.joints[slot].strained << 1));
    if (isD6(data.joints[slot].type)) add(hash, data.d6[slot]);
    if (isLink(data.joints[slot].type)) add(hash, data.links[slot]);
  });
  forEachPair(data, [&](const PairData& pair) { add(hash, pair); });
  for (const SoftTouch& touch : data.softTouches) add(hash, touch);
  data.softIds.forEach([&](uint32_t slot) {
    hash.values(data.softs[slot].memory.pressures);
    hash.values(data.softs[slot].memory.tensions);
  });
  return hash.digest();
}

}  // namespace avbd
