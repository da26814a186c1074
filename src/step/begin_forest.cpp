// Forests: which joints of a batch are solved exactly as trees; those that close loops become rows in tiles.
#include "step/begin_rows.h"
#include "world/joints.h"

namespace avbd {

namespace {

uint32_t find(std::vector<uint32_t>& set, uint32_t i) {
  while (set[i] != i) i = set[i] = set[set[i]];
  return i;
}

/// False if both were in one set already.
bool join(std::vector<uint32_t>& set, uint32_t a, uint32_t b) {
  a = find(set, a), b = find(set, b);
  if (a == b) return false;
  set[a < b ? b : a] = a < b ? a : b;
  return true;
}

void addEdge(ForestScratch& scratch, uint32_t row, uint32_t joint, uint32_t neighbour) {
  scratch.edges.push_back({joint, neighbour, scratch.first[row]});
  scratch.first[row] = static_cast<uint32_t>(scratch.edges.size() - 1);
}

/// Adds row's node and all that hang on it, parents first.
void grow(Forest& forest, ForestScratch& scratch, uint32_t root, int32_t worldJoint) {
  scratch.nodeOf[root] = static_cast<int32_t>(forest.nodes.size());
  forest.nodes.emplace_back();
  forest.nodes.back().row = root;
  forest.nodes.back().joint = worldJoint;
  for (size_t next = forest.nodes.size() - 1; next < forest.nodes.size(); ++next) {
    for (uint32_t e = scratch.first[forest.nodes[next].row]; e != kNone; e = scratch.edges[e].next) {
      const ForestEdge& edge = scratch.edges[e];
      if (scratch.nodeOf[edge.neighbour] >= 0) continue;
      scratch.nodeOf[edge.neighbour] = static_cast<int32_t>(forest.nodes.size());
      TreeNode& node = forest.nodes.emplace_back();
      node.row = edge.neighbour;
      node.parent = static_cast<int32_t>(next);
      node.joint = static_cast<int32_t>(edge.joint);
      forest.joints[edge.joint].childIsA = forest.joints[edge.joint].rowA == edge.neighbour;
    }
  }
}

/// Orients the chosen joints: first what hangs on the world, then free trees from their lowest row.
void orient(Forest& forest, ForestScratch& scratch, uint32_t bodies) {
  scratch.first.assign(bodies, kNone);
  scratch.nodeOf.assign(bodies, -1);
  scratch.edges.clear();
  for (uint32_t i = 0; i < forest.joints.size(); ++i) {
    const TreeJoint& joint = forest.joints[i];
    if (joint.rowA >= bodies || joint.rowB >= bodies) continue;
    addEdge(scratch, joint.rowA, i, joint.rowB);
    addEdge(scratch, joint.rowB, i, joint.rowA);
  }
  for (uint32_t i = 0; i < forest.joints.size(); ++i) {
    TreeJoint& joint = forest.joints[i];
    if (joint.rowA < bodies && joint.rowB < bodies) continue;
    joint.childIsA = joint.rowA < bodies;
    grow(forest, scratch, joint.childIsA ? joint.rowA : joint.rowB, static_cast<int32_t>(i));
  }
  for (uint32_t row = 0; row < bodies; ++row)
    if (scratch.nodeOf[row] < 0 && scratch.first[row] != kNone) grow(forest, scratch, row, -1);
}

uint32_t islandOfRow(const StepData& step, const BatchRange& batch, uint32_t row) {
  uint32_t n = 0;
  while (step.ranges[batch.islandBegin + n].end <= row) ++n;
  return n;
}

Forest& forestOf(StepData& step, BatchRange& batch) {
  if (batch.forest == kNone) {
    if (step.forestCount == step.forests.size()) step.forests.emplace_back();
    batch.forest = step.forestCount++;
    step.forests[batch.forest].nodes.clear();
    step.forests[batch.forest].joints.clear();
    step.forests[batch.forest].mixed.clear();
  }
  return step.forests[batch.forest];
}

void addTet(const WorldData& world, StepData& step, BatchRange& batch, uint32_t slot) {
  step.tetJoint.push_back(slot);
  for (int i = 0; i < 4; ++i) step.tetRow[i].push_back(rowInBatch(world, step, batch, world.joints[slot].body[i]));
}

void addToTree(StepData& step, BatchRange& batch, const TreeJoint& joint) {
  forestOf(step, batch).joints.push_back(joint);
  step.ranges[batch.islandBegin + joint.island].hasTree = true;
}

/// A joint that closes a loop: rows of their own.
void addToTiles(StepData& step, BatchRange& batch, const TreeJoint& joint) {
  auto& lanes = joint.angular ? step.fixedRow : step.ballRow;
  (joint.angular ? step.fixedJoint : step.ballJoint).push_back(joint.slot);
  lanes[0].push_back(joint.rowA), lanes[1].push_back(joint.rowB);
  step.ranges[batch.islandBegin + joint.island].coupled = true;
}

/// A joint whose rows are evaluated one at a time.
void addScalar(const WorldData& world, StepData& step, BatchRange& batch, TreeJoint& joint, bool tree) {
  ScalarJoint scalar;
  scalar.rowA = joint.rowA, scalar.rowB = joint.rowB;
  scalar.slot = joint.slot, scalar.island = joint.island, scalar.inTree = tree;
  if (world.joints[joint.slot].type == JointType::Distance) scalar.kind = ScalarJoint::Kind::Distance;
  step.scalarOf[joint.slot] = static_cast<uint32_t>(step.scalar.size()) - batch.scalarTile * kTile;
  if (tree) {
    Forest& forest = forestOf(step, batch);
    joint.mixed = static_cast<int32_t>(forest.mixed.size());
    forest.mixed.emplace_back().scalar = static_cast<uint32_t>(step.scalar.size()) - batch.scalarTile * kTile;
    addToTree(step, batch, joint);
  } else {
    step.ranges[batch.islandBegin + joint.island].coupled = true;
  }
  step.scalarRow[0].push_back(joint.rowA), step.scalarRow[1].push_back(joint.rowB);
  step.scalar.push_back(scalar);
}

bool isLinked(JointType type) {
  return type == JointType::Pulley || type == JointType::Coupling || type == JointType::Custom;
}

/// A joint over any number of bodies.
void addLinked(const WorldData& world, StepData& step, BatchRange& batch, uint32_t slot, uint32_t island) {
  LinkedJoint& joint = step.linked.emplace_back();
  const JointType type = world.joints[slot].type;
  joint.kind = type == JointType::Pulley     ? LinkedJoint::Kind::Pulley
               : type == JointType::Coupling ? LinkedJoint::Kind::Coupling
                                             : LinkedJoint::Kind::Custom;
  joint.slot = slot, joint.island = island;
  forEachBody(world, slot, [&](uint32_t body) { joint.row[joint.bodies++] = rowInBatch(world, step, batch, body); });
  for (const LinkTerm& term : world.links[slot].terms)
    joint.coupling.term[joint.coupling.terms++].scalar = step.scalarOf[term.joint];
  step.ranges[batch.islandBegin + island].coupled = true;
}

bool hasLocks(const WorldData& world, uint32_t body) { return body != kNone && world.bodies[body].locks != 0; }

void placeJoint(const WorldData& world, StepData& step, BatchRange& batch, uint32_t slot, uint32_t island) {
  const JointData& data = world.joints[slot];
  TreeJoint joint;
  joint.rowA = rowInBatch(world, step, batch, data.body[0]);
  joint.rowB = rowInBatch(world, step, batch, data.body[1]);
  joint.slot = slot, joint.island = island;
  joint.angular = data.type == JointType::Fixed;
  joint.m = joint.angular ? 6 : 3;
  const auto element = [&](uint32_t row) { return row < batch.bodies ? row : batch.bodies; };
  // A locked axis of a child would leave the joint's elimination singular.
  const bool locked = hasLocks(world, data.body[0]) || hasLocks(world, data.body[1]);
  const bool tree = world.def.primalSolver == PrimalSolver::Krylov && !locked &&
                    join(step.planting.set, element(joint.rowA), element(joint.rowB));
  if (isD6(data.type) || data.type == JointType::Distance) {
    addScalar(world, step, batch, joint, tree);
  } else {
    tree ? addToTree(step, batch, joint) : addToTiles(step, batch, joint);
  }
}

}  // namespace

void plantForest(const WorldData& world, StepData& step, BatchRange& batch) {
  std::vector<uint32_t>& set = step.planting.set;
  step.scalarOf.resize(world.joints.size(), kNone);
  set.resize(batch.bodies + 1);
  for (uint32_t i = 0; i <= batch.bodies; ++i) set[i] = i;
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    for (uint32_t i = 0; i < island.jointCount; ++i) {
      const uint32_t slot = step.islandJoints[island.jointBegin + i];
      const JointType type = world.joints[slot].type;
      if (isLinked(type)) continue;
      if (type == JointType::TetVolume) {
        addTet(world, step, batch, slot);
        step.ranges[batch.islandBegin + n].coupled = true;
      } else {
        placeJoint(world, step, batch, slot, n);
      }
    }
    // Couplings name scalar joints by their place.
    for (uint32_t i = 0; i < island.jointCount; ++i) {
      const uint32_t slot = step.islandJoints[island.jointBegin + i];
      if (isLinked(world.joints[slot].type)) addLinked(world, step, batch, slot, n);
    }
  }
  if (batch.forest == kNone) return;
  Forest& forest = step.forests[batch.forest];
  orient(forest, step.planting, batch.bodies);
  for (TreeNode& node : forest.nodes) node.island = islandOfRow(step, batch, node.row);
}

}  // namespace avbd
