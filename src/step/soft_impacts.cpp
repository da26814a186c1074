// Impacts of soft bodies (soft_impacts.h).
#include "step/soft_impacts.h"

#include <algorithm>

#include "avbd/rows/math.h"
#include "step/begin_rows.h"
#include "step/free_motion.h"
#include "world/soft.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

constexpr int kImpulsePasses = 8;    ///< after these what still meets is stopped (soft_stops.cpp)
constexpr float kSlow = 3;           ///< of the thickness: what comes nearer by more in the step is stopped at once
constexpr float kLeastPart = 0.05f;  ///< sum of the squares of the weights of points that yield
constexpr int kSweeps = 8;           ///< over all impacts, in a pass
constexpr float kSoonest = 0.1f;     ///< of the step: what meets earlier is kept apart from then on
constexpr float kFar = 1e18f;

}  // namespace

SoftImpacts::SoftImpacts(WorldData& world, StepData& step)
    : world_(world), step_(step), s_(step.softs), d_(step.softs.impacts) {
  d_.impacts.clear(), d_.met.clear(), d_.changed.clear(), d_.stopped.clear();
}

bool SoftImpacts::moves(uint32_t body) const { return isParticle(world_, body) && !world_.bodies[body].asleep; }

void SoftImpacts::meet(const NearFeatures& near, float time) {
  const FoundTouch found = touchAt(world_, near, time);
  if (!mayTouchSoft(world_, found.touch)) return;
  Impact impact = impactOf(near, found);
  const float start = length(nearestFeatures(near.kind, near.points.at).off);
  impact.start = found.separation + thicknessOf(world_, near) - keptOf(world_, near, start).aim;
  impact.meets = time;
  begin();
  // What comes nearer is nearest in the end; else they meet on the way.
  if (wayOf(impact) >= 0) impact.time = std::max(time, kSoonest);
  impact.isFast = -wayOf(impact) > kSlow * (world_.softs[near.first].radius + world_.softs[near.second].radius);
  add(impact);
}

void SoftImpacts::meet(const ShapePiece& piece, uint32_t soft, uint32_t face, float time) {
  const FoundTouch found = touchAt(world_, step_, soft, piece, face, time);
  if (!mayTouchSoft(world_, found.touch)) return;
  Impact impact = impactOf(piece.namesWith(soft, face), found);
  const float start = nearestToFace(piece, piece.pose, movingFace(world_, s_, soft, face).at, kFar).distance;
  const float thickness = world_.softs[soft].radius;
  impact.start = found.separation + thickness - keptOf(piece, thickness, start).aim;
  const auto shapeWay = [&](float at) {
    const Vec3 turned = rotate(quatFromVector(piece.turn * at), found.arm) - found.arm;
    return dot(impact.normal, piece.linear + turned * (1 / at));
  };
  impact.shapeWay = shapeWay(1);
  impact.meets = time;
  begin();
  // What turns may be nearer on the way than in the end.
  if (impact.start + wayOf(impact) >= 0)
    impact.time = std::max(time, kSoonest), impact.shapeWay = shapeWay(impact.time);
  add(impact);
}

SoftImpacts::Impact SoftImpacts::impactOf(const FeatureNames& names, const FoundTouch& found) const {
  Impact impact;
  impact.ofShape = names.kind == TouchKind::ShapeFace;
  impact.nodes = nodesOf(world_, found.touch), impact.weight = nodeWeights(names.kind, found.touch.anchor);
  impact.normal = found.touch.normal, impact.arm = found.arm;
  const auto& rows = step_.softTouches;
  const auto row = std::lower_bound(rows.begin(), rows.end(), found.touch,
                                    [](const FoundTouch& a, const SoftTouch& b) { return a.touch < b; });
  impact.hasRow = row != rows.end() && !(found.touch < row->touch);
  return impact;
}

void SoftImpacts::add(const Impact& impact) {
  ++world_.report.impacts;
  d_.met.push_back(d_.impacts.size());
  d_.impacts.push_back(impact);
}

/// [1/kg] inverse mass of the points along the normal; 0 if those that yield have hardly a part in it, and would have
/// to go far.
float SoftImpacts::mobilityOf(const Impact& impact) const {
  float mobility = 0, part = 0;
  for (size_t i = 0; i < 4; ++i) {
    if (!yields(impact.nodes[i])) continue;
    const BodyData& body = world_.bodies[impact.nodes[i]];
    const Vec3 n = unlocked(impact.normal, body.locks);
    const float share = impact.weight[i] * impact.weight[i] * dot(n, n);
    mobility += share / body.mass, part += share;
  }
  return part > kLeastPart ? mobility : 0;
}

bool SoftImpacts::yields(uint32_t body) const { return moves(body) && !(d_.stops[body].share < 1); }

/// [m] by which the two sides part along the normal.
float SoftImpacts::wayOf(const Impact& impact) const {
  float way = impact.shapeWay;
  for (size_t i = impact.ofShape ? 1 : 0; i < 4; ++i)
    way -= impact.weight[i] * dot(impact.normal, s_.ways[impact.nodes[i]]);
  return way;
}

void SoftImpacts::begin() {
  if (!s_.ways.empty()) return;
  s_.ways.assign(world_.bodies.size(), {});
  d_.pointOf.resize(world_.bodies.size());
  d_.stops.assign(world_.bodies.size(), {});
  d_.touched.assign(world_.bodies.size(), 0);
  world_.softIds.forEach([&](uint32_t slot) {
    const std::vector<uint32_t>& all = world_.softs[slot].bodies;
    for (uint32_t i = 0; i < all.size(); ++i) {
      d_.pointOf[all[i]] = i;
      if (moves(all[i])) s_.ways[all[i]] = solvedWay(world_, step_, all[i]);
    }
  });
}

void SoftImpacts::setWay(uint32_t body, Vec3 way) {
  if (!moves(body) || way == s_.ways[body]) return;
  s_.ways[body] = way;
  if (d_.touched[body] == 0) d_.changed.push_back(body);
  d_.touched[body] = 1;
}

const std::vector<std::array<uint32_t, 2>>& SoftImpacts::resolve(int pass) {
  for (const uint32_t body : d_.changed) d_.touched[body] = 0;
  d_.changed.clear();
  if (pass < kImpulsePasses) {
    stopMet(pass, true);
    for (int i = 0; i < kSweeps; ++i)
      for (Impact& impact : d_.impacts) push(impact);
    forgetMoved();
  }
  if (!d_.met.empty()) stopMet(pass, false);
  d_.met.clear();
  d_.points.clear();
  for (const uint32_t body : d_.changed) d_.points.push_back({world_.bodies[body].soft, d_.pointOf[body]});
  std::sort(d_.points.begin(), d_.points.end());
  return d_.points;
}

/// What goes on as before would not be looked at again, and needs more.
void SoftImpacts::forgetMoved() {
  std::erase_if(d_.met, [&](size_t index) {
    const auto& nodes = d_.impacts[index].nodes;
    return std::any_of(nodes.begin(), nodes.end(), [&](uint32_t node) { return d_.touched[node] != 0; });
  });
}

/// One step of Gauss-Seidel; impulses only push.
void SoftImpacts::push(Impact& impact) {
  const float mobility = impact.isFast ? 0 : mobilityOf(impact);
  if (!(mobility > 0)) return;
  const float spare = impact.start + impact.time * wayOf(impact);
  const float impulse = std::max(impact.impulse - spare / (impact.time * mobility), 0.0f);
  const float more = impulse - impact.impulse;
  if (more == 0) return;
  impact.impulse = impulse;
  for (size_t i = 0; i < 4; ++i) {
    const uint32_t slot = impact.nodes[i];
    if (!moves(slot) || impact.weight[i] == 0) continue;
    const BodyData& body = world_.bodies[slot];
    const Vec3 push = unlocked(impact.normal, body.locks) * (-more * impact.weight[i]);
    if (yields(slot))
      setWay(slot, s_.ways[slot] + push * (1 / body.mass));
    else
      d_.stops[slot].taken = d_.stops[slot].taken + push;
  }
}

bool SoftImpacts::isPushed(uint32_t slot) const {
  return world_.bodies[slot].type == BodyType::Dynamic && !world_.bodies[slot].asleep;
}

void SoftImpacts::end() {
  if (s_.ways.empty()) return;
  for (const Impact& impact : d_.impacts)
    if (impact.ofShape && impact.impulse > 0 && isPushed(impact.nodes[0]))
      pushBody(impact.nodes[0], impact.arm, impact.normal * impact.impulse);
  giveBack();
  world_.softIds.forEach([&](uint32_t slot) {
    for (const uint32_t body : world_.softs[slot].bodies)
      if (moves(body)) endPoint(body);
  });
  s_.ways.clear();
}

/// The body has gone on, so it is its velocity that changes.
void SoftImpacts::pushBody(uint32_t slot, Vec3 arm, Vec3 impulse) {
  const BodyData& body = world_.bodies[slot];
  StepData::EndState& end = step_.end[step_.endOf[slot]];
  impulse = impulse * (1 / step_.h);
  end.linearVelocity = end.linearVelocity + unlocked(impulse * (1 / body.mass), body.locks);
  if ((body.locks >> 3) != 0) return;
  const auto torque = toRow(cross(arm, impulse));
  end.angularVelocity =
      end.angularVelocity + fromRow(turnedProduct(toRow(body.invInertia), toRow(body.rotation), torque));
}

void SoftImpacts::endPoint(uint32_t slot) {
  const BodyData& body = world_.bodies[slot];
  const uint32_t index = step_.endOf[slot];
  StepData::EndState& end = step_.end[index];
  const Vec3 way = s_.ways[slot], solved = solvedWay(world_, step_, slot);
  if (way == solved) return;
  float* d = step_.d.data() + size_t(8) * step_.rowOfEnd[index];
  d[0] = way.x, d[1] = way.y, d[2] = way.z;
  end.position = body.position + way;
  // What no row knew of keeps its velocity, as the next step has one.
  const bool keeps = d_.stops[slot].share < 1 && !d_.stops[slot].hadRow;
  end.linearVelocity = end.linearVelocity + ((keeps ? d_.stops[slot].way : way) - solved) * (1 / step_.h);
}

}  // namespace avbd
