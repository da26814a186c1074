// Colours: no two bodies of one colour share a row, and they follow from the order of the bodies alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "step/step_data.h"

namespace avbd {
namespace {

/// A world of random rows, as the islands' stage leaves it.
struct Graph {
  WorldData world;
  StepData step;

  explicit Graph(uint32_t bodies) {
    world.def.primalSolver = PrimalSolver::BlockSweep;
    world.bodies.resize(bodies);
    for (uint32_t i = 0; i < bodies; ++i) step.order.push_back(i);
  }
  void setType(uint32_t body, BodyType type) {
    world.bodies[body].type = type;
    std::erase(step.order, body);
  }
  void addPair(uint32_t a, uint32_t b) {
    step.islandPairs.push_back(static_cast<uint32_t>(world.pairs.size()));
    PairData pair;
    pair.bodyA = a, pair.bodyB = b;
    world.pairs.insert({&pair, 1});
    step.found.push_back(foundContact(world, pair));
  }
  void addJoint(JointType type, std::initializer_list<uint32_t> bodies) {
    step.islandJoints.push_back(static_cast<uint32_t>(world.joints.size()));
    world.joints.emplace_back();
    world.joints.back().type = type;
    std::copy(bodies.begin(), bodies.end(), world.joints.back().body);
  }
  bool moves(uint32_t body) const { return body != kNone && world.bodies[body].type == BodyType::Dynamic; }
  /// By body; kNone of those that are not dynamic.
  std::vector<uint32_t> color() {
    colorBlocks(world, step);
    std::vector<uint32_t> colors(world.bodies.size(), kNone);
    for (size_t i = 0; i < step.order.size(); ++i) colors[step.order[i]] = step.coloring.ofOrder[i];
    return colors;
  }
  /// Dynamic bodies that share a row with this one.
  std::vector<uint32_t> neighbours(uint32_t body) const {
    std::vector<uint32_t> found;
    const auto addRow = [&](const uint32_t* row, size_t count) {
      if (std::find(row, row + count, body) == row + count) return;
      for (size_t i = 0; i < count; ++i)
        if (row[i] != body && moves(row[i])) found.push_back(row[i]);
    };
    for (const PairData& pair : world.pairs) {
      const uint32_t row[2] = {pair.bodyA, pair.bodyB};
      addRow(row, 2);
    }
    for (const JointData& joint : world.joints) addRow(joint.body, joint.type == JointType::TetVolume ? 4 : 2);
    return found;
  }
};

Graph randomGraph(uint32_t seed) {
  std::mt19937 random(seed);
  Graph graph(120);
  const auto any = [&] { return static_cast<uint32_t>(random() % 120); };
  for (const uint32_t fixed : {0u, 50u}) graph.setType(fixed, BodyType::Static);
  graph.setType(70, BodyType::Kinematic);
  for (int i = 0; i < 200; ++i)
    if (const uint32_t a = any(), b = any(); a != b) graph.addPair(a, b);
  for (uint32_t i = 10; i < 49; ++i) graph.addPair(9, i);  // one body that many touch
  for (uint32_t i = 0; i < 119; ++i) graph.addPair(i < 70 ? 0 : 70, i < 70 ? i + 1 : i);
  for (int i = 0; i < 20; ++i)
    if (const uint32_t a = any(), b = any(); a != b) graph.addJoint(JointType::Ball, {a, b});
  graph.addJoint(JointType::Fixed, {3, kNone});
  for (uint32_t i = 0; i < 20; ++i) graph.addJoint(JointType::TetVolume, {i, i + 30, i + 60, i + 90});
  return graph;
}

TEST(Colors, NoTwoBodiesOfOneColorShareARow) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    Graph graph = randomGraph(seed);
    const std::vector<uint32_t> color = graph.color();
    for (const uint32_t body : graph.step.order) {
      ASSERT_LT(color[body], graph.step.coloring.colors);
      for (const uint32_t other : graph.neighbours(body))
        ASSERT_NE(color[body], color[other]) << body << " and " << other;
    }
    EXPECT_EQ(graph.world.report.colors, graph.step.coloring.colors);
  }
}

TEST(Colors, EachBodyTakesTheLowestThatItsEarlierNeighboursLeave) {
  Graph graph = randomGraph(1);
  const std::vector<uint32_t> color = graph.color();
  for (const uint32_t body : graph.step.order) {
    std::vector<bool> taken(graph.step.coloring.colors, false);
    for (const uint32_t other : graph.neighbours(body))
      if (other < body) taken[color[other]] = true;
    EXPECT_EQ(color[body], std::find(taken.begin(), taken.end(), false) - taken.begin()) << body;
  }
}

TEST(Colors, StaticAndKinematicBodiesCountForNothing) {
  Graph graph(4);
  graph.setType(0, BodyType::Static);
  graph.setType(1, BodyType::Kinematic);
  for (const uint32_t fixed : {0u, 1u})
    for (const uint32_t body : {2u, 3u}) graph.addPair(fixed, body);
  EXPECT_EQ(graph.color()[2], 0u);
  EXPECT_EQ(graph.color()[3], 0u);
  EXPECT_EQ(graph.color()[0], kNone);
  EXPECT_EQ(graph.world.report.colors, 1u);
}

TEST(Colors, FourBodiesOfATetrahedronDiffer) {
  Graph graph(4);
  graph.addJoint(JointType::TetVolume, {3, 1, 0, 2});
  EXPECT_EQ(graph.color(), (std::vector<uint32_t>{0, 1, 2, 3}));
}

TEST(Colors, OrderOfRowsAndFormerStepsChangeNothing) {
  Graph graph = randomGraph(3), other = randomGraph(3);
  const std::vector<uint32_t> color = graph.color();
  std::reverse(other.step.islandPairs.begin(), other.step.islandPairs.end());
  std::reverse(other.step.islandJoints.begin(), other.step.islandJoints.end());
  EXPECT_EQ(other.color(), color);
  EXPECT_EQ(other.color(), color);
  EXPECT_EQ(graph.color(), color);
  Graph small(3);
  std::swap(small.step.coloring, graph.step.coloring);  // memory of a larger step
  small.addPair(0, 1);
  EXPECT_EQ(small.color(), (std::vector<uint32_t>{0, 1, 0}));
  EXPECT_EQ(small.step.coloring.ofOrder, (std::vector<uint32_t>{0, 1, 0}));
  EXPECT_EQ(small.world.report.colors, 2u);
}

TEST(Colors, KrylovHasNone) {
  Graph graph = randomGraph(4);
  graph.color();
  graph.world.def.primalSolver = PrimalSolver::Krylov;
  colorBlocks(graph.world, graph.step);
  EXPECT_EQ(graph.world.report.colors, 0u);
}

}  // namespace
}  // namespace avbd
