#include "hierarchy/refinement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "formfactor/free_segments.hpp"
#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::even_light;
using test_scenes::RefinedTree;
using test_scenes::TreeOfScene;

using Pair = std::pair<NodeId, NodeId>;

/// Links of two nodes by their ancestors: which of them hold a pair of leaves.
class LinksOfLeaves {
 public:
  LinksOfLeaves(const NodeTree& tree, std::span<const Link> links) : tree_(tree) {
    for (const Link& link : links) of_.insert({std::min(link.p, link.q), std::max(link.p, link.q)});
  }

  [[nodiscard]] std::size_t count(NodeId a, NodeId b) const {
    std::size_t found = 0;
    for (NodeId p = a; p != kNoNode; p = tree_[p].parent)
      for (NodeId q = b; q != kNoNode; q = tree_[q].parent)
        found += of_.count({std::min(p, q), std::max(p, q)});
    return found;
  }

 private:
  const NodeTree& tree_;
  std::multiset<Pair> of_;
};

/// Whether a few hundred segments between the two find a free one.
bool see_each_other(const TreeOfScene& made, NodeId a, NodeId b, std::mt19937& random) {
  const NodeTree& tree = made.tree;
  for (int packet = 0; packet < 16; ++packet) {
    std::vector<SurfaceSegment> segments;
    for (int k = 0; k < RayPacket::kSize; ++k) {
      const glm::dvec3 from = test_scenes::random_point(tree, a, random),
                       to = test_scenes::random_point(tree, b, random);
      const double above_a = glm::dot(tree[a].shape.normal, to - from),
                   above_b = glm::dot(tree[b].shape.normal, from - to);
      if (std::min(above_a, above_b) > 1e-3)
        segments.push_back({from, tree[a].shape.normal, to, tree[b].shape.normal});
    }
    if (!segments.empty() && free_segments(made.ray_scene, segments) != 0) return true;
  }
  return false;
}

/// Every pair of leaves that sees each other lies in one link, and none in two. Returns the pairs that see
/// each other.
std::size_t expect_each_pair_once(const RefinedTree& made) {
  std::mt19937 random(1);
  const std::vector<NodeId> leaves = made.leaves();
  const LinksOfLeaves links(made.tree, made.links);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t count = links.count(leaves[i], leaves[j]);
      EXPECT_LE(count, 1U) << leaves[i] << " " << leaves[j];
      if (count == 1 || !see_each_other(made, leaves[i], leaves[j], random)) continue;
      ADD_FAILURE() << leaves[i] << " and " << leaves[j] << " are in no link";
    }
    for (std::size_t j = 0; j < i; ++j) seen += links.count(leaves[i], leaves[j]);
  }
  return seen;
}

TEST(Refinement, EveryPairOfLeavesThatSeeEachOtherIsInOneLink) {
  const RefinedTree cube(test_scenes::unit_cube(), 5e-4);
  const std::size_t leaves = cube.leaves().size();
  EXPECT_GT(leaves, 100U);
  EXPECT_GT(expect_each_pair_once(cube), leaves * leaves / 3);
  const RefinedTree room(test_scenes::room_with_box(), 3e-3);
  EXPECT_GT(room.leaves().size(), 60U);
  EXPECT_GT(expect_each_pair_once(room), 1000U);
}

TEST(Refinement, ClustersHoldTheirPairsOnceToo) {
  const RefinedTree plates(test_scenes::random_plates(80, 0.15, Sides::two, 3), 5e-3);
  std::size_t of_clusters = 0;
  for (const Link& link : plates.links)
    of_clusters += plates.tree.is_cluster(link.p) || plates.tree.is_cluster(link.q) ? 1 : 0;
  EXPECT_GT(of_clusters, 50U);
  EXPECT_LT(of_clusters, plates.links.size());
  expect_each_pair_once(plates);
}

// Of all pairs of faces a few neighbours exchange nearly all, and few random pairs of points are of
// neighbours.
TEST(Refinement, ManySmallNeighboursInOneCluster) {
  constexpr int kScenes = 40, kPairs = 60;
  std::mt19937 random(1);
  double found = 0, exact = 0;
  for (int k = 0; k < kScenes; ++k) {
    Scene scene = by_hand::empty_scene(Sides::one);
    for (int pair = 0; pair < kPairs; ++pair) {
      const glm::dvec3 at = test_scenes::uniform_point(random, 0, 100), up(0, 0, 0.2);
      const std::array<glm::dvec3, 4> square{at, at + glm::dvec3(1, 0, 0), at + glm::dvec3(1, 1, 0),
                                             at + glm::dvec3(0, 1, 0)};
      by_hand::add(scene, "low", {square[0], square[1], square[2], square[3]});
      by_hand::add(scene, "high", {square[0] + up, square[3] + up, square[2] + up, square[1] + up});
    }
    const TreeOfScene made(test_scenes::finished(std::move(scene)));
    const Refiner refiner(made.ray_scene, made.tree);
    RefinedPairs whole;
    refiner.refine({0, 0}, even_light(made.tree), {1e6, 1}, whole);
    ASSERT_EQ(whole.links.size(), 1U);
    ASSERT_EQ(whole.links[0].q, 0U);
    found += static_cast<double>(whole.links[0].G);
    exact += 2 * kPairs * 0.69022;  // unit squares a fifth apart; others add a thousandth
  }
  EXPECT_NEAR(found / exact, 1, 0.1);
}

TEST(Refinement, TheLinksOfAFaceOfAClosedCubeAddUpToItsArea) {
  for (const double error : {1e-2, 1e-3, 1e-4}) {
    const RefinedTree cube(test_scenes::unit_cube(), error);
    double G_error = 0;
    for (const Link& link : cube.links) {
      EXPECT_FALSE(link.partial);
      EXPECT_GT(link.G, 0);
      G_error = std::max(G_error, static_cast<double>(link.G_error));
    }
    for (std::size_t piece = 0; piece < 6; ++piece) {
      const NodeId face = cube.tree.face(piece, true);
      double sum = 0;
      for (const Link& link : cube.links)
        if (test_scenes::is_within(cube.tree, link.p, face) ||
            test_scenes::is_within(cube.tree, link.q, face))
          sum += static_cast<double>(link.G);
      EXPECT_NEAR(sum, 1, 0.02 * std::sqrt(error)) << cube.links.size() << " links, G_error " << G_error;
    }
  }
}

TEST(Refinement, NoLinkPastAWallThatBlocks) {
  const RefinedTree open(test_scenes::squares_and_wall(test_scenes::kNoWall), 1e-3);
  double sum = 0;
  for (const Link& link : open.links) sum += static_cast<double>(link.G);
  EXPECT_NEAR(sum, 0.19982, 1e-4);  // two squares opposite each other
  const RefinedTree closed(test_scenes::squares_and_wall(test_scenes::kWholeWall), 1e-3);
  for (const Link& link : closed.links) EXPECT_EQ(link.G, 0);
  EXPECT_LT(closed.links.size(), open.links.size() / 4);
}

TEST(Refinement, WhatStandsBetweenIsTakenOff) {
  // Half of every segment's cross-section at the middle: by symmetry half of the light.
  const RefinedTree made(test_scenes::squares_and_wall(test_scenes::kWallOfSmallX), 1e-3);
  double sum = 0;
  std::size_t partial = 0;
  for (const Link& link : made.links) {
    sum += static_cast<double>(link.G);
    partial += link.partial ? 1 : 0;
  }
  EXPECT_NEAR(sum, 0.09991, 1e-3);
  EXPECT_GT(partial, 0U);
  EXPECT_LT(partial, made.links.size());
}

/// A tree that grows no more, so that goals can be compared.
struct FixedTree : TreeOfScene {
  explicit FixedTree(Scene of) : TreeOfScene(std::move(of)), refiner((halve_all(4), ray_scene), tree) {}

  [[nodiscard]] RefinedPairs refined(double error) const {
    RefinedPairs found;
    refiner.refine({0, 0}, even_light(tree), {error, 1}, found);
    return found;
  }

  Refiner refiner;
};

TEST(Refinement, SlopesOfWhatIsHiddenPointToWhatIsOpen) {
  for (const auto& [wall, open] : {std::pair(test_scenes::kWallOfSmallX, glm::dvec3(1, 0, 0)),
                                   std::pair(test_scenes::kWallOfSmallY, glm::dvec3(0, 1, 0))}) {
    const TreeOfScene made(test_scenes::squares_and_wall(wall));
    RefinedPairs found;
    Refiner(made.ray_scene, made.tree)
        .refine({made.tree.face(0, true), made.tree.face(1, true)}, even_light(made.tree), {1e-4, 1, true},
                found);
    ASSERT_EQ(found.links.size(), 1U);
    const Link& link = found.links[0];
    ASSERT_TRUE(link.partial);
    for (const auto& [node, slope] : {std::pair(link.p, link.over_p), std::pair(link.q, link.over_q)}) {
      const PlaneAxes& axes = made.tree.axes(node);
      const glm::dvec3 along =
          (static_cast<double>(slope.u) * axes.u + static_cast<double>(slope.v) * axes.v) / kSlopeOne;
      // The exchange is all in about one half: x + x' > 1.
      EXPECT_GT(glm::dot(along, open), 0.7);
      EXPECT_NEAR(glm::length(along - glm::dot(along, open) * open), 0, 0.1);
    }
  }
}

TEST(Refinement, AFinerGoalRefinesWhatACoarserOneHas) {
  for (const Scene& scene :
       {test_scenes::room_with_box(), test_scenes::random_plates(30, 0.4, Sides::two, 2)}) {
    const FixedTree made(scene);
    for (double error = 0x1p-4; error > 0x1p-9; error /= 2) {
      const RefinedPairs coarse = made.refined(error), fine = made.refined(error / 2);
      EXPECT_GE(fine.links.size() + fine.open.size(), coarse.links.size() + coarse.open.size());
      std::set<Pair> of_coarse;
      for (const Link& link : coarse.links) of_coarse.insert({link.p, link.q});
      for (const NodePair& pair : coarse.open) of_coarse.insert({pair.p, pair.q});
      for (const Link& link : fine.links) {
        bool held = false;
        for (NodeId p = link.p; p != kNoNode; p = made.tree[p].parent)
          for (NodeId q = link.q; q != kNoNode; q = made.tree[q].parent)
            held = held || of_coarse.count({p, q}) + of_coarse.count({q, p}) > 0;
        EXPECT_TRUE(held) << link.p << " " << link.q;
      }
    }
  }
}

TEST(Refinement, WhatHasJustBeenAcceptedIsEnough) {
  for (const Scene& scene : {test_scenes::unit_cube(), test_scenes::room_with_box(),
                             test_scenes::random_plates(40, 0.5, Sides::two, 4),
                             test_scenes::random_plates(40, 0.1, Sides::one, 5)}) {
    const FixedTree made(scene);
    const std::vector<NodeLight> light = even_light(made.tree);
    for (const double error : {1e-2, 1e-3, 1e-4}) {
      const RefinedPairs found = made.refined(error);
      EXPECT_FALSE(found.links.empty() && found.open.empty());
      std::size_t poor = 0;
      for (const Link& link : found.links)
        poor += made.refiner.oracle(light, {error, 1}).is_enough(link) ? 0 : 1;
      EXPECT_EQ(poor, 0U) << "of " << found.links.size() << " at " << error;
    }
    std::size_t poor = 0;
    for (const Link& link : made.refined(1e-2).links)
      poor += made.refiner.oracle(light, {1e-6, 1}).is_enough(link) ? 0 : 1;
    EXPECT_GT(poor, 0U);
  }
}

TEST(Refinement, NoGoalIsFinerThanWhatCanBeIntegrated) {
  const TreeOfScene made(test_scenes::unit_cube());
  const Refiner refiner(made.ray_scene, made.tree);
  // Light without deviation leaves the form factors' errors alone.
  const std::vector<NodeLight> light(made.tree.size(), {1, 0, 0.5F, 1});
  for (const double error : {1e-2, 1e-4, 1e-6, 1e-9, 1e-12}) {
    RefinedPairs found;
    refiner.refine({0, 0}, light, {error, 1}, found);
    ASSERT_EQ(found.links.size(), 15U);
    for (const Link& link : found.links)
      EXPECT_TRUE(refiner.oracle(light, {error, 1}).is_enough(link)) << error;
  }
}

// Else the lamp's row sum may be anything: a cluster that holds it shines on its own back.
TEST(Refinement, LightThatFallsOnBlackIsNotWhereverItMayBe) {
  const TreeOfScene made(test_scenes::unit_cube());
  const Refiner refiner(made.ray_scene, made.tree);
  const NodeLight bright{1000, 0, 0, 1}, black{0, 0, 0, 1};
  std::vector<NodeLight> light(made.tree.size(), black);
  const auto p = static_cast<NodeId>(made.tree.clusters()), q = p + 1;
  light[p] = bright;
  const LinkOracle oracle = refiner.oracle(light, {0.1, 1});
  EXPECT_GT(oracle.weight(p, q), 0);
  EXPECT_GT(oracle.cluster_error(0, p), 1);
  const double as_black = oracle.weight(p, q);
  light[q].rho = 2 * static_cast<float>(kLeastReflectance);
  EXPECT_NEAR(refiner.oracle(light, {0.1, 1}).weight(p, q), 2 * as_black, 1e-6 * as_black);
}

TEST(Refinement, ConvexScenesNeedNoRays) {
  Scene scene = test_scenes::unit_cube();
  scene.statistics.convex = true;
  const FixedTree made(std::move(scene));
  for (const double error : {1e-2, 1e-3}) {
    const RefinedPairs found = made.refined(error);
    EXPECT_EQ(found.counts.rays, 0U);
    EXPECT_EQ(found.counts.shafts, 0U);
    for (const Link& link : found.links) EXPECT_FALSE(link.partial);
  }
}

TEST(Refinement, LightDecides) {
  const FixedTree made(test_scenes::room_with_box());
  const RefinementGoal goal{1e-3, 1};
  const auto pairs = [&](const std::vector<NodeLight>& light) {
    RefinedPairs found;
    made.refiner.refine({0, 0}, light, goal, found);
    return found.links.size() + found.open.size();
  };
  std::vector<NodeLight> light = even_light(made.tree);
  const std::size_t even = pairs(light);
  for (NodeLight& of_node : light) of_node.importance = 0.1F;
  EXPECT_LT(pairs(light), even);
  light = even_light(made.tree);
  for (NodeLight& of_node : light) of_node.rho = 0.05F;
  EXPECT_LT(pairs(light), even);
  light = even_light(made.tree);
  for (NodeLight& of_node : light) of_node.B = of_node.deviation = 0.1F;
  EXPECT_LT(pairs(light), even);
  light = even_light(made.tree);
  for (NodeLight& of_node : light) of_node.deviation = 0;
  EXPECT_LT(pairs(light), even);
}

TEST(Refinement, TheSameForEveryPieceOfTheWay) {
  // From the root, and from all pairs below it on their own.
  const FixedTree made(test_scenes::random_plates(20, 0.4, Sides::one, 6));
  RefinedPairs parts;
  const auto& [a, b] = made.tree[0].child;
  for (const NodePair& pair : {NodePair{a, a}, NodePair{a, b}, NodePair{b, b}})
    made.refiner.refine(pair, even_light(made.tree), {1e-2, 1}, parts);
  const RefinedPairs whole = made.refined(1e-2);
  ASSERT_EQ(parts.links.size(), whole.links.size());
  for (std::size_t k = 0; k < whole.links.size(); ++k) {
    EXPECT_EQ(parts.links[k].p, whole.links[k].p);
    EXPECT_EQ(parts.links[k].q, whole.links[k].q);
    EXPECT_EQ(parts.links[k].G, whole.links[k].G);
  }
  EXPECT_EQ(parts.open, whole.open);
}

TEST(Refinement, OpenPairsNameTheLeafThatTheyWait) {
  const FixedTree made(test_scenes::unit_cube());
  const RefinedPairs found = made.refined(1e-6);
  ASSERT_GT(found.open.size(), 100U);
  ASSERT_EQ(found.open.size(), found.wanted.size());
  for (std::size_t k = 0; k < found.open.size(); ++k) {
    EXPECT_EQ(found.open[k].p, found.wanted[k].halving.leaf);
    EXPECT_TRUE(made.tree[found.wanted[k].halving.leaf].is_leaf());
  }
}

/// What of a list can be compared with another in any order.
std::vector<std::array<double, 3>> sorted(const RefinedPairs& found) {
  std::vector<std::array<double, 3>> all;
  for (const Link& link : found.links)
    all.push_back({static_cast<double>(link.p), static_cast<double>(link.q), static_cast<double>(link.G)});
  for (const NodePair& pair : found.open)
    all.push_back({static_cast<double>(pair.p), static_cast<double>(pair.q), -1});
  std::ranges::sort(all);
  return all;
}

TEST(Refinement, AFewVisitsAtATimeComeToTheSame) {
  for (const Scene& scene :
       {test_scenes::room_with_box(), test_scenes::random_plates(30, 0.4, Sides::two, 2)}) {
    const FixedTree made(scene);
    const RefinedPairs whole = made.refined(1e-3);
    for (const std::size_t visits : {1U, 2U, 7U, 64U}) {
      RefinedPairs parts;
      parts.pending = {{{0, 0}}};
      while (!parts.pending.empty()) {
        const PendingPair pair = parts.pending.back();
        parts.pending.pop_back();
        const auto size = [&] { return parts.links.size() + parts.open.size() + parts.pending.size(); };
        const std::size_t before = size();
        made.refiner.refine(pair, even_light(made.tree), {1e-3, 1}, visits, parts);
        ASSERT_LE(size(), before + 1 + 2 * visits);
      }
      EXPECT_EQ(sorted(parts), sorted(whole)) << visits;
      EXPECT_EQ(parts.counts.pairs, whole.counts.pairs);
      EXPECT_EQ(parts.counts.shafts, whole.counts.shafts);
    }
  }
}

TEST(Refinement, EveryPairCanBeSettledAsItIs) {
  const FixedTree made(test_scenes::random_plates(30, 0.4, Sides::two, 2));
  const std::vector<NodeLight> light = even_light(made.tree);
  for (NodeId p = 0; p < made.tree.whole(); ++p) {
    for (NodeId q = p; q < made.tree.whole(); ++q) {
      RefinedPairs found;
      made.refiner.refine({{p, q}}, light, {1e-9, 1, true}, 1, found);
      EXPECT_TRUE(found.open.empty() && found.pending.empty());
      EXPECT_LE(found.links.size(), 1U);
    }
  }
}

TEST(Refinement, SettledPairsAreExactInTheMean) {
  const FixedTree cube(test_scenes::unit_cube());
  RefinedPairs found;
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < a; ++b)
      cube.refiner.refine({cube.tree.face(a, true), cube.tree.face(b, true)}, even_light(cube.tree),
                          {1e-6, 1, true}, found);
  EXPECT_TRUE(found.open.empty());
  EXPECT_EQ(found.links.size(), 15U);
  for (std::size_t piece = 0; piece < 6; ++piece) {
    double sum = 0;
    for (const Link& link : found.links)
      if (link.p == cube.tree.face(piece, true) || link.q == cube.tree.face(piece, true))
        sum += static_cast<double>(link.G);
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

}  // namespace
}  // namespace fluxel
