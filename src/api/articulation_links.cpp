// Articulations: what is set of all links at once (articulation.h). Links are bodies of the world, which keeps it.
#include <avbd/articulation.h>
#include <avbd/world.h>

#include <algorithm>
#include <set>

#include "api/articulation_check.h"
#include "world/limits.h"

namespace avbd {
namespace {

using BodyPair = std::array<BodyId, 2>;

BodyPair sorted(BodyPair pair) { return {std::min(pair[0], pair[1]), std::max(pair[0], pair[1])}; }

/// Ascending.
std::vector<BodyId> livingLinks(const World& world, const Articulation& tree, const Path& call) {
  articulation::checkLinks(call, world, tree);
  std::vector<BodyId> ids;
  for (const ArticulationLink& link : tree.links()) ids.push_back(link.body);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::set<BodyPair> checkedPairs(const World& world, std::span<const BodyPair> pairs, std::span<const BodyId> links,
                                const Path& path) {
  std::set<BodyPair> out;
  for (size_t i = 0; i < pairs.size(); ++i) {
    const Path pair = path[i];
    for (size_t side = 0; side < 2; ++side) {
      const BodyId body = pairs[i][side];
      if (!world.isAlive(body)) pair[side].refuse(toText(body), "must name a living body of this world");
      if (!std::binary_search(links.begin(), links.end(), body))
        pair[side].refuse(toText(body), "must name a body of the articulation");
    }
    if (pairs[i][0] == pairs[i][1]) pair[1].refuse(toText(pairs[i][1]), "must differ from the other link");
    out.insert(sorted(pairs[i]));
  }
  return out;
}

}  // namespace

void Articulation::setSelfCollision(World& world, const SelfCollision& rule) const {
  const Path call("Articulation::setSelfCollision"), path = call / "rule";
  const std::vector<BodyId> links = livingLinks(world, *this, call);
  const std::set<BodyPair> excluded = checkedPairs(world, rule.excluded, links, path / "excluded");
  for (size_t i = 0; i < links.size(); ++i) {
    for (size_t j = i + 1; j < links.size(); ++j) {
      if (!rule.enabled || excluded.contains({links[i], links[j]}))
        world.excludeCollision(links[i], links[j]);
      else
        world.allowCollision(links[i], links[j]);
    }
  }
}

void Articulation::setIterations(World& world, int iterations) const {
  const Path call("Articulation::setIterations");
  const std::vector<BodyId> links = livingLinks(world, *this, call);
  check(call / "iterations", iterations, Range{0, kMaxIterations});
  for (const BodyId link : links) world.setIterations(link, iterations);
}

std::vector<std::array<BodyId, 2>> Articulation::excludedPairs(const World& world) const {
  const std::vector<BodyId> links = livingLinks(world, *this, Path("Articulation::excludedPairs"));
  const auto isLink = [&](BodyId id) { return std::binary_search(links.begin(), links.end(), id); };
  std::vector<BodyPair> pairs = world.excludedPairs();
  std::erase_if(pairs, [&](const BodyPair& pair) { return !isLink(pair[0]) || !isLink(pair[1]); });
  return pairs;
}

}  // namespace avbd
