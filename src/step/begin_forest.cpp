// Forests: which joints of a batch are solved exactly as trees; those that close loops become rows in tiles.
#include "step/begin_rows.h"

namespace avbd {

namespace {

/// Union-find over the rows of a batch; the world is one more element.
class Sets {
 public:
  explicit Sets(uint32_t count) : parent_(count) {
    for (uint32_t i = 0; i < count; ++i) parent_[i] = i;
  }
  /// False if both were in one set already.
  bool join(uint32_t a, uint32_t b) {
    a = find(a), b = find(b);
    if (a == b) return false;
    parent_[a < b ? b : a] = a < b ? a : b;
    return true;
  }

 private:
  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::vector<uint32_t> parent_;
};

struct Edge {
  uint32_t joint;     ///< index in Forest::joints
  uint32_t neighbour; ///< row
};

/// Adds row's node and all that hang on it, parents first.
void grow(Forest& forest, const std::vector<std::vector<Edge>>& edges, std::vector<int32_t>& nodeOf, uint32_t root,
          int32_t worldJoint) {
  nodeOf[root] = static_cast<int32_t>(forest.nodes.size());
  forest.nodes.push_back({});
  forest.nodes.back().row = root;
  forest.nodes.back().joint = worldJoint;
  for (size_t next = forest.nodes.size() - 1; next < forest.nodes.size(); ++next) {
    const uint32_t row = forest.nodes[next].row;
    for (const Edge& edge : edges[row]) {
      if (nodeOf[edge.neighbour] >= 0) continue;
      nodeOf[edge.neighbour] = static_cast<int32_t>(forest.nodes.size());
      TreeNode node;
      node.row = edge.neighbour;
      node.parent = static_cast<int32_t>(next);
      node.joint = static_cast<int32_t>(edge.joint);
      forest.nodes.push_back(node);
      forest.joints[edge.joint].childIsA = forest.joints[edge.joint].rowA == edge.neighbour;
    }
  }
}

/// Orients the chosen joints: first what hangs on the world, then free trees from their lowest row.
void orient(Forest& forest, uint32_t bodies) {
  std::vector<std::vector<Edge>> edges(bodies);
  std::vector<int32_t> nodeOf(bodies, -1);
  for (uint32_t i = 0; i < forest.joints.size(); ++i) {
    const TreeJoint& joint = forest.joints[i];
    if (joint.rowA >= bodies || joint.rowB >= bodies) continue;
    edges[joint.rowA].push_back({i, joint.rowB});
    edges[joint.rowB].push_back({i, joint.rowA});
  }
  for (uint32_t i = 0; i < forest.joints.size(); ++i) {
    TreeJoint& joint = forest.joints[i];
    if (joint.rowA < bodies && joint.rowB < bodies) continue;
    joint.childIsA = joint.rowA < bodies;
    grow(forest, edges, nodeOf, joint.childIsA ? joint.rowA : joint.rowB, static_cast<int32_t>(i));
  }
  for (uint32_t row = 0; row < bodies; ++row)
    if (nodeOf[row] < 0 && !edges[row].empty()) grow(forest, edges, nodeOf, row, -1);
}

uint32_t islandOfRow(const StepData& step, const BatchRange& batch, uint32_t row) {
  uint32_t n = 0;
  while (step.ranges[batch.islandBegin + n].end <= row) ++n;
  return n;
}

void addTet(const WorldData& world, StepData& step, BatchRange& batch, uint32_t slot) {
  step.tetJoint.push_back(slot);
  for (int i = 0; i < 4; ++i) step.tetRow[i].push_back(rowInBatch(world, step, batch, world.joints[slot].body[i]));
}

}  // namespace

void plantForest(const WorldData& world, StepData& step, BatchRange& batch) {
  Sets sets(batch.bodies + 1);
  Forest* forest = nullptr;
  const auto element = [&](uint32_t row) { return row < batch.bodies ? row : batch.bodies; };
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    IslandRange& range = step.ranges[batch.islandBegin + n];
    for (uint32_t i = 0; i < island.jointCount; ++i) {
      const uint32_t slot = step.islandJoints[island.jointBegin + i];
      const JointData& joint = world.joints[slot];
      if (joint.type == JointType::TetVolume) {
        addTet(world, step, batch, slot);
        range.coupled = true;
        continue;
      }
      const uint32_t a = rowInBatch(world, step, batch, joint.body[0]);
      const uint32_t b = rowInBatch(world, step, batch, joint.body[1]);
      const bool angular = joint.type == JointType::Fixed;
      if (sets.join(element(a), element(b))) {
        if (!forest) {
          if (step.forestCount == step.forests.size()) step.forests.emplace_back();
          batch.forest = step.forestCount++;
          forest = &step.forests[batch.forest];
          forest->nodes.clear(), forest->joints.clear();
        }
        TreeJoint& tree = forest->joints.emplace_back();
        tree.rowA = a, tree.rowB = b, tree.slot = slot, tree.angular = angular, tree.m = angular ? 6 : 3;
        tree.island = n;
        range.hasTree = true;
        continue;
      }
      auto& lanes = angular ? step.fixedRow : step.ballRow;
      (angular ? step.fixedJoint : step.ballJoint).push_back(slot);
      lanes[0].push_back(a), lanes[1].push_back(b);
      range.coupled = true;
    }
  }
  if (!forest) return;
  orient(*forest, batch.bodies);
  for (TreeNode& node : forest->nodes) node.island = islandOfRow(step, batch, node.row);
}

}  // namespace avbd
