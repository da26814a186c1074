// Forests: which joints of a batch are solved exactly as trees; the others become rows of their own.
//
// The bodies stand in breadth-first order from the world, so that what closes loops joins neighbours in the order and
// the factor stays narrow (begin_fill.cpp).
#include <algorithm>

#include "step/begin_rows.h"
#include "world/joints.h"

namespace avbd {

namespace {

void addEdge(ForestScratch& scratch, uint32_t row, uint32_t joint, uint32_t neighbour) {
  scratch.edges.push_back({joint, neighbour, scratch.first[row]});
  scratch.first[row] = static_cast<uint32_t>(scratch.edges.size() - 1);
}

bool isLinked(JointType type) {
  return type == JointType::Pulley || type == JointType::Coupling || type == JointType::Custom;
}

bool hasLocks(const WorldData& world, uint32_t body) { return body != kNone && world.bodies[body].locks != 0; }

/// All joints of the batch between two bodies, and the edges of those that a tree can hold.
void listJoints(const WorldData& world, StepData& step, BatchRange& batch) {
  ForestScratch& scratch = step.planting;
  scratch.joints.clear(), scratch.edges.clear();
  scratch.first.assign(batch.bodies, kNone);
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    for (uint32_t i = 0; i < island.jointCount; ++i) {
      const uint32_t slot = step.islandJoints[island.jointBegin + i];
      const JointData& data = world.joints[slot];
      if (isLinked(data.type) || data.type == JointType::TetVolume) continue;
      PlannedJoint& planned = scratch.joints.emplace_back();
      planned.rowA = rowInBatch(world, step, batch, data.body[0]);
      planned.rowB = rowInBatch(world, step, batch, data.body[1]);
      planned.slot = slot, planned.island = n;
      planned.angular = data.type == JointType::Fixed;
      // A locked axis of a child would leave the joint's elimination singular.
      planned.eligible = world.def.primalSolver == PrimalSolver::Krylov && !hasLocks(world, data.body[0]) &&
                         !hasLocks(world, data.body[1]);
      if (!planned.eligible || planned.rowA >= batch.bodies || planned.rowB >= batch.bodies) continue;
      const auto index = static_cast<uint32_t>(scratch.joints.size() - 1);
      addEdge(scratch, planned.rowA, index, planned.rowB);
      addEdge(scratch, planned.rowB, index, planned.rowA);
    }
  }
}

/// Adds a row's node unless it stands already.
bool addNode(Forest& forest, ForestScratch& scratch, uint32_t row, uint32_t island, int32_t parent, int32_t joint) {
  if (scratch.nodeOf[row] >= 0) return false;
  scratch.nodeOf[row] = static_cast<int32_t>(forest.nodes.size());
  TreeNode& node = forest.nodes.emplace_back();
  node.row = row, node.island = island, node.parent = parent, node.joint = joint;
  if (joint < 0) return true;
  PlannedJoint& planned = scratch.joints[static_cast<size_t>(joint)];
  planned.inTree = true;
  planned.childIsA = planned.rowA == row;
  return true;
}

/// Adds all that hang on the nodes from `next` on, level by level.
void grow(Forest& forest, ForestScratch& scratch, size_t next) {
  for (; next < forest.nodes.size(); ++next)
    for (uint32_t e = scratch.first[forest.nodes[next].row]; e != kNone; e = scratch.edges[e].next) {
      const ForestEdge& edge = scratch.edges[e];
      const PlannedJoint& joint = scratch.joints[edge.joint];
      if (joint.eligible)
        addNode(forest, scratch, edge.neighbour, joint.island, static_cast<int32_t>(next),
                static_cast<int32_t>(edge.joint));
    }
}

/// First what hangs on the world, then free trees from their lowest row.
void orient(Forest& forest, ForestScratch& scratch, uint32_t bodies) {
  scratch.nodeOf.assign(bodies, -1);
  for (uint32_t i = 0; i < scratch.joints.size(); ++i) {
    const PlannedJoint& joint = scratch.joints[i];
    if (!joint.eligible || (joint.rowA < bodies && joint.rowB < bodies)) continue;
    const uint32_t row = joint.rowA < bodies ? joint.rowA : joint.rowB;
    if (row < bodies) addNode(forest, scratch, row, joint.island, -1, static_cast<int32_t>(i));
  }
  grow(forest, scratch, 0);
  for (uint32_t row = 0; row < bodies; ++row) {
    if (scratch.first[row] == kNone) continue;
    const PlannedJoint& joint = scratch.joints[scratch.edges[scratch.first[row]].joint];
    if (!joint.eligible || !addNode(forest, scratch, row, joint.island, -1, -1)) continue;
    grow(forest, scratch, forest.nodes.size() - 1);
  }
}

/// Bodies that only rows outside of trees hold: nodes of their own, so that the factor can couple them.
void addLoneNodes(const WorldData& world, StepData& step, BatchRange& batch, Forest& forest) {
  const auto add = [&](uint32_t row, uint32_t island) {
    if (row < batch.bodies) addNode(forest, step.planting, row, island, -1, -1);
  };
  for (const PlannedJoint& planned : step.planting.joints)
    if (!planned.inTree && !step.planting.wide[planned.island])
      add(planned.rowA, planned.island), add(planned.rowB, planned.island);
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    if (step.planting.wide[n]) continue;
    for (uint32_t i = 0; i < island.jointCount; ++i) {
      const uint32_t slot = step.islandJoints[island.jointBegin + i];
      if (!isLinked(world.joints[slot].type)) continue;
      forEachBody(world, slot, [&](uint32_t body) { add(rowInBatch(world, step, batch, body), n); });
    }
  }
}

void addTet(const WorldData& world, StepData& step, BatchRange& batch, uint32_t slot) {
  step.tetJoint.push_back(slot);
  for (int i = 0; i < 4; ++i) step.tetRow[i].push_back(rowInBatch(world, step, batch, world.joints[slot].body[i]));
}

/// A joint that no tree holds: rows of their own.
void addToTiles(StepData& step, PlannedJoint& planned) {
  auto& lanes = planned.angular ? step.fixedRow : step.ballRow;
  auto& joints = planned.angular ? step.fixedJoint : step.ballJoint;
  planned.lane = static_cast<uint32_t>(joints.size());
  joints.push_back(planned.slot);
  lanes[0].push_back(planned.rowA), lanes[1].push_back(planned.rowB);
}

/// A joint whose rows are evaluated one at a time.
void addScalar(const WorldData& world, StepData& step, const BatchRange& batch, PlannedJoint& planned) {
  ScalarJoint scalar;
  scalar.rowA = planned.rowA, scalar.rowB = planned.rowB;
  scalar.slot = planned.slot, scalar.island = planned.island, scalar.inTree = planned.inTree;
  if (world.joints[planned.slot].type == JointType::Distance) scalar.kind = ScalarJoint::Kind::Distance;
  planned.lane = static_cast<uint32_t>(step.scalar.size());
  step.scalarOf[planned.slot] = planned.lane - batch.scalarTile * kTile;
  step.scalarRow[0].push_back(planned.rowA), step.scalarRow[1].push_back(planned.rowB);
  step.scalar.push_back(scalar);
}

void addToTree(StepData& step, Forest& forest, const PlannedJoint& planned) {
  const uint32_t row = planned.childIsA ? planned.rowA : planned.rowB;
  forest.nodes[static_cast<size_t>(step.planting.nodeOf[row])].joint = static_cast<int32_t>(forest.joints.size());
  TreeJoint& joint = forest.joints.emplace_back();
  joint.rowA = planned.rowA, joint.rowB = planned.rowB;
  joint.slot = planned.slot, joint.island = planned.island;
  joint.angular = planned.angular, joint.childIsA = planned.childIsA;
  joint.m = planned.angular ? 6 : 3;
  if (!planned.scalar) return;
  joint.mixed = static_cast<int32_t>(forest.mixed.size());
  forest.mixed.emplace_back().scalar = step.scalarOf[planned.slot];
}

/// Joints in the order of their slots within islands, to the tree or to tiles.
void placeJoints(const WorldData& world, StepData& step, const BatchRange& batch, Forest& forest) {
  for (PlannedJoint& planned : step.planting.joints) {
    const JointType type = world.joints[planned.slot].type;
    planned.scalar = isD6(type) || type == JointType::Distance;
    if (planned.scalar)
      addScalar(world, step, batch, planned);
    else if (!planned.inTree)
      addToTiles(step, planned), step.ranges[batch.islandBegin + planned.island].inTiles = true;
    if (planned.inTree) addToTree(step, forest, planned);
  }
}

/// A joint over any number of bodies.
void addLinked(const WorldData& world, StepData& step, BatchRange& batch, uint32_t slot, uint32_t island) {
  LinkedJoint& joint = step.linked.emplace_back();
  const JointType type = world.joints[slot].type;
  joint.kind = type == JointType::Pulley     ? LinkedJoint::Kind::Pulley
               : type == JointType::Coupling ? LinkedJoint::Kind::Coupling
                                             : LinkedJoint::Kind::Custom;
  joint.slot = slot, joint.island = island;
  forEachBody(world, slot, [&](uint32_t body) {
    const int at = joint.bodies++;
    joint.row[at] = rowInBatch(world, step, batch, body);
    int first = 0;
    while (joint.row[first] != joint.row[at]) ++first;
    joint.first[at] = static_cast<uint8_t>(first);
  });
  for (const LinkTerm& term : world.links[slot].terms)
    joint.coupling.term[joint.coupling.terms++].scalar = step.scalarOf[term.joint];
}

/// What couples more than two bodies; after the scalar joints, which couplings name by their place.
void placeOthers(const WorldData& world, StepData& step, BatchRange& batch) {
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    for (uint32_t i = 0; i < island.jointCount; ++i) {
      const uint32_t slot = step.islandJoints[island.jointBegin + i];
      const JointType type = world.joints[slot].type;
      if (type == JointType::TetVolume) {
        addTet(world, step, batch, slot);
        step.ranges[batch.islandBegin + n].coupled = true;
      } else if (isLinked(type)) {
        addLinked(world, step, batch, slot, n);
      }
    }
  }
}

bool hasJoints(const StepData& step, const BatchRange& batch) {
  const Island* first = step.islands.data() + batch.islandBegin;
  return std::any_of(first, first + batch.islandCount, [](const Island& island) { return island.jointCount > 0; });
}

Forest& emptyForest(StepData& step) {
  if (step.forestCount == step.forests.size()) step.forests.emplace_back();
  step.forests[step.forestCount].clear();
  return step.forests[step.forestCount];
}

}  // namespace

void plantForest(const WorldData& world, StepData& step, BatchRange& batch) {
  if (!hasJoints(step, batch)) return;
  step.scalarOf.resize(world.joints.size(), kNone);
  listJoints(world, step, batch);
  Forest& forest = emptyForest(step);
  step.planting.wide.assign(batch.bodies, 0);  // as many islands at most
  orient(forest, step.planting, batch.bodies);
  const bool exact = world.def.primalSolver == PrimalSolver::Krylov;
  if (exact && releaseWide(step, batch, forest)) {
    forest.clear();
    for (PlannedJoint& planned : step.planting.joints) planned.inTree = false;
    orient(forest, step.planting, batch.bodies);
  }
  if (exact) addLoneNodes(world, step, batch, forest);
  placeJoints(world, step, batch, forest);
  placeOthers(world, step, batch);
  for (const TreeNode& node : forest.nodes) step.ranges[batch.islandBegin + node.island].hasTree = true;
  if (!forest.nodes.empty()) batch.forest = step.forestCount++;
  exact ? fillForest(step, batch, forest) : leaveLoops(step, batch);
}

}  // namespace avbd
