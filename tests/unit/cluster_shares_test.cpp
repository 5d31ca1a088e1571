#include "hierarchy/cluster_shares.hpp"

#include <gtest/gtest.h>

#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::TreeOfScene;

constexpr std::size_t kUp = 4;  // of the directions

/// The part of a face in what a node above it exchanges by a way.
double share_of(const NodeTree& tree, NodeId face, NodeId above, std::size_t way) {
  double product = 1;
  for (; face != above; face = tree[face].parent) product *= tree.shares(face)[way];
  return product;
}

/// A closed room whose floor a small box stands on, far from the walls.
TreeOfScene box_on_floor() {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "room", glm::dvec3(-5, -5, 0), glm::dvec3(5, 5, 10), false);
  by_hand::add_box(scene, "box", {-0.5, -0.5, 0}, {0.5, 0.5, 1}, true);
  return TreeOfScene(test_scenes::finished(std::move(scene)));
}

/// The faces of the box: sides, top and the bottom.
struct FacesOfBox {
  explicit FacesOfBox(const NodeTree& tree) {
    for (std::size_t id = tree.clusters(); id < tree.whole(); ++id) {
      const Node& node = tree[static_cast<NodeId>(id)];
      if (std::abs(node.shape.area - 1) > 1e-9 || glm::length(node.shape.centroid) > 2) continue;
      const auto face = static_cast<NodeId>(id);
      if (node.shape.normal.z < -0.5) bottom = face;
      if (node.shape.normal.z > 0.5 && node.shape.centroid.z > 0.5) top = face;
      if (std::abs(node.shape.normal.z) < 0.5) sides.push_back(face);
    }
  }
  NodeId top = kNoNode, bottom = kNoNode;
  std::vector<NodeId> sides;
};

NodeId above_both(const NodeTree& tree, NodeId a, NodeId b) {
  while (!test_scenes::is_within(tree, b, a)) a = tree[a].parent;
  return a;
}

TEST(ClusterShares, AreByAreaBeforeAnyRay) {
  const TreeOfScene made(test_scenes::random_plates(20, 0.5, Sides::two, 7));
  for (std::size_t id = 1; id < made.tree.whole(); ++id) {
    const Node& node = made.tree[static_cast<NodeId>(id)];
    for (const double share : made.tree.shares(static_cast<NodeId>(id)))
      EXPECT_NEAR(share, node.shape.area / made.tree[node.parent].shape.area, 1e-12);
  }
}

TEST(ClusterShares, ChildrenMakeUpTheirCluster) {
  TreeOfScene made(test_scenes::random_plates(40, 0.5, Sides::two, 7));
  made.share_out();
  bool uneven = false;
  for (std::size_t id = 0; id < made.tree.clusters(); ++id) {
    const auto [a, b] = made.tree[static_cast<NodeId>(id)].child;
    const double by_area = made.tree[a].shape.area / made.tree[static_cast<NodeId>(id)].shape.area;
    for (std::size_t way = 0; way < kWays; ++way) {
      const double share = made.tree.shares(a)[way];
      EXPECT_NEAR(share + made.tree.shares(b)[way], 1, 1e-12);
      EXPECT_GE(share, 0);
      EXPECT_LE(share, 1);
      uneven = uneven || std::abs(share - by_area) > 0.05;
    }
    EXPECT_NEAR(made.tree.shares(a)[kWithin], by_area, 1e-12);
  }
  EXPECT_TRUE(uneven);
}

TEST(ClusterShares, WhatABoxStandsOnGetsNothing) {
  TreeOfScene made = box_on_floor();
  const NodeTree& tree = made.tree;
  const FacesOfBox box(tree);
  ASSERT_NE(box.bottom, kNoNode);
  ASSERT_NE(box.top, kNoNode);
  ASSERT_EQ(box.sides.size(), 4U);
  const NodeId whole = above_both(tree, box.bottom, box.top);
  EXPECT_GT(share_of(tree, box.bottom, whole, kUp), 0);
  made.share_out();
  for (std::size_t way = 0; way < kDirections; ++way)
    EXPECT_EQ(share_of(tree, box.bottom, whole, way), 0) << way;
}

// A box whose faces look along the axes.
TEST(ClusterShares, FacesThatLookAWayHaveMostOfIt) {
  TreeOfScene made = box_on_floor();
  made.share_out();
  const NodeTree& tree = made.tree;
  const FacesOfBox box(tree);
  for (const NodeId side : box.sides) {
    const NodeId above = above_both(tree, side, box.top);
    EXPECT_GT(share_of(tree, box.top, above, kUp), 2 * share_of(tree, side, above, kUp));
    const glm::dvec3& normal = tree[side].shape.normal;
    const std::size_t way = way_parts(normal).way[std::abs(normal.x) > 0.5 ? 0 : 1];
    EXPECT_GT(share_of(tree, side, above, way), 2 * share_of(tree, box.top, above, way));
    EXPECT_LT(share_of(tree, side, above, opposite(way)), 0.1 * share_of(tree, side, above, way));
  }
}

TEST(ClusterShares, PartsOfADirectionSumToOne) {
  for (const glm::dvec3 direction :
       {glm::dvec3(1, 2, -3), glm::dvec3(0, 0, -5), glm::dvec3(-1e-9, 1e-9, 0)}) {
    const WayParts there = way_parts(direction), back = way_parts(-direction);
    EXPECT_NEAR(there.part[0] + there.part[1] + there.part[2], 1, 1e-12);
    for (std::size_t k = 0; k < 3; ++k) {
      if (there.part[k] == 0) continue;
      EXPECT_EQ(back.way[k], opposite(there.way[k]));
      EXPECT_EQ(back.part[k], there.part[k]);
      EXPECT_EQ(there.way[k], 2 * k + (direction[static_cast<int>(k)] < 0 ? 1 : 0));
    }
  }
  EXPECT_EQ(way_parts(glm::dvec3(0)).way[0], kWithin);
  EXPECT_EQ(way_parts(glm::dvec3(0)).part[0], 1);
  EXPECT_EQ(opposite(kWithin), kWithin);
}

TEST(ClusterShares, PartsOfTheFacesAddUpToTheWhole) {
  TreeOfScene made(test_scenes::random_plates(40, 0.5, Sides::two, 9));
  std::vector<NodeId> all, even, odd;
  for (std::size_t k = made.tree.clusters(); k < made.tree.whole(); ++k) {
    all.push_back(static_cast<NodeId>(k));
    (k % 2 == 0 ? even : odd).push_back(static_cast<NodeId>(k));
  }
  const auto whole = light_out(made.ray_scene, made.tree, all, 2);
  auto sum = light_out(made.ray_scene, made.tree, even, 1);
  const auto other = light_out(made.ray_scene, made.tree, odd, 1);
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += other[k];
  EXPECT_EQ(sum, whole);
  EXPECT_GT(*std::ranges::max_element(whole), 0U);
}

TEST(ClusterShares, WithoutLightThatLeavesTheyStayByArea) {
  TreeOfScene made(test_scenes::random_plates(20, 0.5, Sides::two, 7));
  const std::vector<WayShares> shares =
      cluster_shares(made.tree, std::vector<std::uint64_t>(kDirections * made.tree.whole()));
  for (std::size_t id = 1; id < made.tree.whole(); ++id)
    for (std::size_t way = 0; way < kWays; ++way)
      EXPECT_NEAR(shares[id][way], made.tree.shares(static_cast<NodeId>(id))[way], 1e-15);
}

}  // namespace
}  // namespace fluxel
