// Loops that a forest's factor holds: the pattern of its fill.
//
// Nodes are eliminated from the last to the first. A node's front is all that it is coupled to by then: ends of its
// loops, its parent, and the fronts of those eliminated before it that begin with it. What closes small loops, or many
// in a row as in a scissor lift, has narrow fronts and is solved exactly; a net has wide ones, and its loops are left
// to the conjugate gradients.
#include <algorithm>

#include "step/begin_rows.h"

namespace avbd {

namespace {

/// Blocks of fill that pay: a wide front costs its square.
constexpr uint32_t kBlocksPerBody = 40, kBlocksAnyway = 600;

void addToFront(ForestScratch& scratch, int32_t node, int32_t other) {
  scratch.links.push_back({static_cast<uint32_t>(other), scratch.frontOf[static_cast<size_t>(node)]});
  scratch.frontOf[static_cast<size_t>(node)] = static_cast<uint32_t>(scratch.links.size() - 1);
}

void couple(ForestScratch& scratch, uint32_t rowA, uint32_t rowB, uint32_t bodies) {
  if (rowA >= bodies || rowB >= bodies || rowA == rowB) return;
  const int32_t a = scratch.nodeOf[rowA], b = scratch.nodeOf[rowB];
  if (a < 0 || b < 0) return;  // has no node yet
  addToFront(scratch, std::max(a, b), std::min(a, b));
}

/// The ends of all loops.
void listLoops(StepData& step, const BatchRange& batch, const Forest& forest) {
  ForestScratch& scratch = step.planting;
  scratch.links.clear();
  scratch.frontOf.assign(forest.nodes.size(), kNone);
  for (const PlannedJoint& planned : scratch.joints)
    if (!planned.inTree && !scratch.wide[planned.island]) couple(scratch, planned.rowA, planned.rowB, batch.bodies);
  for (size_t i = batch.linkedBegin; i < step.linked.size(); ++i) {
    const LinkedJoint& joint = step.linked[i];
    if (scratch.wide[joint.island]) continue;
    for (int a = 0; a < joint.bodies; ++a)
      for (int b = 0; b < a; ++b) couple(scratch, joint.row[a], joint.row[b], batch.bodies);
  }
}

/// The node's front without doubles, first those that are eliminated first.
void collectFront(ForestScratch& scratch, const Forest& forest, int32_t node) {
  std::vector<int32_t>& front = scratch.front;
  front.clear();
  for (uint32_t l = scratch.frontOf[static_cast<size_t>(node)]; l != kNone; l = scratch.links[l].next)
    front.push_back(static_cast<int32_t>(scratch.links[l].other));
  const TreeNode& at = forest.nodes[static_cast<size_t>(node)];
  if (at.joint >= 0 && at.parent >= 0) front.push_back(at.parent);
  std::sort(front.begin(), front.end(), std::greater<>());
  front.erase(std::unique(front.begin(), front.end()), front.end());
}

uint32_t mostBlocks(const IslandRange& island) {
  return std::max(kBlocksAnyway, kBlocksPerBody * (island.end - island.begin));
}

/// Fronts of all nodes whose islands can afford theirs, in ForestScratch::fronts.
void findFronts(StepData& step, const BatchRange& batch, Forest& forest) {
  ForestScratch& scratch = step.planting;
  scratch.fronts.clear();
  scratch.blocks.assign(batch.bodies, 0);
  for (size_t i = forest.nodes.size(); i-- > 0;) {
    TreeNode& node = forest.nodes[i];
    const uint32_t most = mostBlocks(step.ranges[batch.islandBegin + node.island]);
    uint32_t& blocks = scratch.blocks[node.island];
    if (scratch.frontOf[i] == kNone || blocks > most) continue;
    collectFront(scratch, forest, static_cast<int32_t>(i));
    const auto size = static_cast<uint32_t>(scratch.front.size());
    blocks += size * size;
    if (blocks > most) continue;
    for (uint32_t k = 1; k < size; ++k) addToFront(scratch, scratch.front[0], scratch.front[k]);
    node.fillBegin = static_cast<uint32_t>(scratch.fronts.size()), node.fillCount = size;
    scratch.fronts.insert(scratch.fronts.end(), scratch.front.begin(), scratch.front.end());
  }
}

bool affords(const StepData& step, const BatchRange& batch, uint32_t island) {
  return !step.planting.wide[island] &&
         step.planting.blocks[island] <= mostBlocks(step.ranges[batch.islandBegin + island]);
}

void fillPair(const StepData& step, const BatchRange& batch, Forest& forest, const PlannedJoint& joint) {
  if (joint.rowA >= batch.bodies || joint.rowB >= batch.bodies) return;
  const int32_t a = step.planting.nodeOf[joint.rowA], b = step.planting.nodeOf[joint.rowB];
  FilledPair pair;
  pair.kind = joint.scalar    ? FilledPair::Kind::Scalar
              : joint.angular ? FilledPair::Kind::Fixed
                              : FilledPair::Kind::Ball;
  const uint32_t tile = joint.scalar ? batch.scalarTile : joint.angular ? batch.fixedTile : batch.ballTile;
  pair.lane = joint.lane - tile * kTile;
  pair.childIsA = a > b, pair.island = joint.island;
  pair.fill = forest.fillOf(std::max(a, b), std::min(a, b));
  forest.filledPairs.push_back(pair);
}

void fillLinked(const StepData& step, const BatchRange& batch, Forest& forest, uint32_t index) {
  const LinkedJoint& joint = step.linked[batch.linkedBegin + index];
  for (int i = 0; i < joint.bodies; ++i)
    for (int j = 0; j < i; ++j) {
      if (joint.first[i] != i || joint.first[j] != j) continue;
      if (joint.row[i] >= batch.bodies || joint.row[j] >= batch.bodies) continue;
      const int32_t a = step.planting.nodeOf[joint.row[i]], b = step.planting.nodeOf[joint.row[j]];
      forest.filledLinks.push_back(
          {index, a > b ? i : j, a > b ? j : i, joint.island, forest.fillOf(std::max(a, b), std::min(a, b))});
    }
}

}  // namespace

bool releaseWide(StepData& step, const BatchRange& batch, Forest& forest) {
  ForestScratch& scratch = step.planting;
  listLoops(step, batch, forest);
  if (scratch.links.empty()) return false;
  findFronts(step, batch, forest);
  bool any = false;
  for (uint32_t n = 0; n < batch.islandCount; ++n)
    if (!affords(step, batch, n)) scratch.wide[n] = any = true;
  for (TreeNode& node : forest.nodes) node.fillCount = 0;
  if (!any) return false;
  for (PlannedJoint& planned : scratch.joints)
    if (scratch.wide[planned.island]) planned.eligible = false;
  return true;
}

void leaveLoops(StepData& step, const BatchRange& batch) {
  for (const PlannedJoint& planned : step.planting.joints)
    if (!planned.inTree) step.ranges[batch.islandBegin + planned.island].coupled = true;
  for (size_t i = batch.linkedBegin; i < step.linked.size(); ++i)
    step.ranges[batch.islandBegin + step.linked[i].island].coupled = true;
}

void fillForest(StepData& step, const BatchRange& batch, Forest& forest) {
  listLoops(step, batch, forest);
  findFronts(step, batch, forest);
  forest.fills.resize(step.planting.fronts.size());
  for (size_t i = 0; i < forest.fills.size(); ++i) forest.fills[i].node = step.planting.fronts[i];
  for (uint32_t n = 0; n < batch.islandCount; ++n)
    if (!affords(step, batch, n)) step.ranges[batch.islandBegin + n].coupled = true;
  for (TreeNode& node : forest.nodes)
    if (!affords(step, batch, node.island)) node.fillCount = 0;
  for (const PlannedJoint& planned : step.planting.joints)
    if (!planned.inTree && affords(step, batch, planned.island)) fillPair(step, batch, forest, planned);
  for (size_t i = batch.linkedBegin; i < step.linked.size(); ++i)
    if (affords(step, batch, step.linked[i].island))
      fillLinked(step, batch, forest, static_cast<uint32_t>(i - batch.linkedBegin));
}

}  // namespace avbd
