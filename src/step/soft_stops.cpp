// What impulses do not keep apart (soft_impacts.h) goes less far: a share of its way beyond that of all that have met.
// In the end only that is left, and what goes the same way from where it was apart stays apart.
#include <algorithm>

#include "base/disjoint_sets.h"
#include "step/soft_impacts.h"

namespace avbd {

namespace {

constexpr int kShorterPasses = 8;  ///< after these what still meets goes with its group
constexpr int kPointPasses = 30;   ///< after these all points of the soft body do

}  // namespace

uint32_t SoftImpacts::groupOf(uint32_t member) { return setOf(d_.parent, member); }

void SoftImpacts::addToGroup(uint32_t slot) {
  const BodyData& body = world_.bodies[slot];
  const bool particle = isParticle(world_, slot);
  Group& group = d_.groups[groupOf(particle ? body.soft : static_cast<uint32_t>(world_.softs.size()) + slot)];
  if (body.type != BodyType::Dynamic || body.asleep) {
    group.held = std::min(group.held, slot);
    return;
  }
  const Vec3 way = !particle                  ? solvedWay(world_, step_, slot)
                   : d_.stops[slot].share < 1 ? d_.stops[slot].way
                                              : s_.ways[slot];
  group.mass += body.mass, group.way = group.way + way * body.mass;
}

const std::vector<uint32_t>& SoftImpacts::bodiesOfShapes() {
  std::vector<uint32_t>& bodies = d_.shapes;
  bodies.clear();
  for (const Impact& impact : d_.impacts)
    if (impact.ofShape) bodies.push_back(impact.nodes[0]);
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

/// All that has met, and the mean of how far it goes.
void SoftImpacts::findGroups() {
  const auto softs = static_cast<uint32_t>(world_.softs.size());
  d_.parent.resize(softs + world_.bodies.size());
  for (uint32_t i = 0; i < d_.parent.size(); ++i) d_.parent[i] = i;
  const auto memberOf = [&](uint32_t slot) {
    return isParticle(world_, slot) ? world_.bodies[slot].soft : softs + slot;
  };
  for (const Impact& impact : d_.impacts) join(d_.parent, memberOf(impact.nodes[0]), memberOf(impact.nodes[3]));
  d_.groups.assign(d_.parent.size(), {});
  world_.softIds.forEach([&](uint32_t slot) {
    for (const uint32_t body : world_.softs[slot].bodies) addToGroup(body);
  });
  for (const uint32_t body : bodiesOfShapes()) addToGroup(body);
  for (Group& group : d_.groups) {
    if (group.held != kNone) {
      const BodyData& body = world_.bodies[group.held];
      group.way = body.type == BodyType::Kinematic ? body.linearVelocity * step_.h : Vec3{};
    } else if (group.mass > 0) {
      group.way = group.way * (1 / group.mass);
    }
  }
}

void SoftImpacts::stopMet(int pass, bool onlyFast) {
  bool any = false;
  for (const size_t index : d_.met) {
    const Impact& impact = d_.impacts[index];
    if (onlyFast && !impact.isFast) continue;
    any = true;
    for (const uint32_t node : impact.nodes) {
      if (!isParticle(world_, node)) continue;
      if (pass < kPointPasses || impact.ofShape)
        stop(node, pass < kShorterPasses ? impact.meets : 0.0f, impact.hasRow);
      else
        for (const uint32_t body : world_.softs[world_.bodies[node].soft].bodies) stop(body, 0, impact.hasRow);
    }
  }
  if (!any) return;
  findGroups();
  for (const uint32_t body : d_.stopped) {
    const Vec3 way = d_.groups[groupOf(world_.bodies[body].soft)].way;
    setWay(body, way + (d_.stops[body].way - way) * d_.stops[body].share);
  }
}

void SoftImpacts::stop(uint32_t body, float share, bool hasRow) {
  if (!moves(body)) return;
  Stop& stop = d_.stops[body];
  if (stop.share == 1) stop.way = s_.ways[body], stop.hadRow = true, d_.stopped.push_back(body);
  stop.share = std::min(stop.share * share, 0.9f);
  stop.hadRow = stop.hadRow && hasRow;
}

/// Groups that nothing holds keep their momentum: all in them share what stops took.
void SoftImpacts::giveBack() {
  if (d_.stopped.empty()) return;
  for (const uint32_t body : d_.stopped) {
    Group& group = d_.groups[groupOf(world_.bodies[body].soft)];
    group.lost = group.lost + d_.stops[body].taken;
    if (d_.stops[body].hadRow)
      group.lost = group.lost + (d_.stops[body].way - s_.ways[body]) * world_.bodies[body].mass;
  }
  const auto give = [&](uint32_t slot, const Group& group) {
    if (group.held != kNone || group.lost == Vec3{}) return;
    StepData::EndState& end = step_.end[step_.endOf[slot]];
    end.linearVelocity = end.linearVelocity + group.lost * (1 / (group.mass * step_.h));
  };
  world_.softIds.forEach([&](uint32_t slot) {
    for (const uint32_t body : world_.softs[slot].bodies) give(body, d_.groups[groupOf(slot)]);
  });
  for (const uint32_t body : bodiesOfShapes())
    if (isPushed(body)) give(body, d_.groups[groupOf(static_cast<uint32_t>(world_.softs.size()) + body)]);
}

}  // namespace avbd
