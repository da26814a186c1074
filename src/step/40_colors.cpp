// Colours: bodies of one colour share no row, so the block sweep may move them at once. Krylov needs none.
//
// Greedy in the order of the islands and, within one, of the bodies: each takes the lowest colour that no neighbour
// has. Static and kinematic bodies do not move in the solve and so count for nothing.
#include <algorithm>

#include "step/step_data.h"
#include "world/joints.h"

namespace avbd {

namespace {

void link(const WorldData& world, Coloring& c, const uint32_t* body, int count) {
  const auto moves = [&](uint32_t slot) { return slot != kNone && world.bodies[slot].type == BodyType::Dynamic; };
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      if (moves(body[i]) && moves(body[j])) c.links.push_back({c.at[body[i]], c.at[body[j]]});
}

void findLinks(const WorldData& world, const StepData& step, Coloring& c) {
  c.links.clear();
  for (const uint32_t index : step.islandPairs) {
    const uint32_t body[2] = {step.found[index].bodyA, step.found[index].bodyB};
    link(world, c, body, 2);
  }
  for (const uint32_t slot : step.islandJoints) {
    uint32_t bodies[kLinkBodies];
    int count = 0;
    // A body that stands in a coupling twice is no neighbour of itself.
    forEachBody(world, slot, [&](uint32_t body) {
      if (std::find(bodies, bodies + count, body) == bodies + count) bodies[count++] = body;
    });
    link(world, c, bodies, count);
  }
}

void listNeighbours(size_t bodies, Coloring& c) {
  c.first.assign(bodies + 1, 0);
  for (const auto& l : c.links) ++c.first[l[0]], ++c.first[l[1]];
  uint32_t end = 0;
  for (uint32_t& f : c.first) f = end += f;
  c.neighbour.resize(end);
  for (const auto& l : c.links) c.neighbour[--c.first[l[0]]] = l[1], c.neighbour[--c.first[l[1]]] = l[0];
}

}  // namespace

void colorBlocks(WorldData& world, StepData& step) {
  Coloring& c = step.coloring;
  c.colors = 0;
  world.report.colors = 0;
  if (world.def.primalSolver != PrimalSolver::BlockSweep) return;
  c.at.resize(world.bodies.size());
  for (uint32_t i = 0; i < step.order.size(); ++i) c.at[step.order[i]] = i;
  findLinks(world, step, c);
  listNeighbours(step.order.size(), c);
  c.ofOrder.assign(step.order.size(), kNone);
  c.takenBy.clear();
  for (uint32_t i = 0; i < step.order.size(); ++i) {
    for (uint32_t n = c.first[i]; n < c.first[i + 1]; ++n)
      if (c.ofOrder[c.neighbour[n]] != kNone) c.takenBy[c.ofOrder[c.neighbour[n]]] = i;
    const uint32_t color = static_cast<uint32_t>(
        std::find_if(c.takenBy.begin(), c.takenBy.end(), [i](uint32_t by) { return by != i; }) - c.takenBy.begin());
    if (color == c.takenBy.size()) c.takenBy.push_back(kNone);
    c.ofOrder[i] = color;
  }
  c.colors = static_cast<uint32_t>(c.takenBy.size());
  world.report.colors = c.colors;
}

}  // namespace avbd
