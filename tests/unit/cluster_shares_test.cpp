#include "hierarchy/cluster_shares.hpp"

#include <gtest/gtest.h>

#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::TreeOfScene;

/// The part of a face in what a node above it exchanges.
double share_of(const NodeTree& tree, NodeId face, NodeId above) {
  double product = 1;
  for (; face != above; face = tree[face].parent) product *= tree.share(face);
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
    EXPECT_NEAR(made.tree.share(static_cast<NodeId>(id)), node.shape.area / made.tree[node.parent].shape.area,
                1e-12);
  }
}

TEST(ClusterShares, ChildrenMakeUpTheirCluster) {
  TreeOfScene made(test_scenes::random_plates(40, 0.5, Sides::two, 7));
  made.share_out();
  bool uneven = false;
  for (std::size_t id = 0; id < made.tree.clusters(); ++id) {
    const auto [a, b] = made.tree[static_cast<NodeId>(id)].child;
    EXPECT_NEAR(made.tree.share(a) + made.tree.share(b), 1, 1e-12);
    EXPECT_GE(made.tree.share(a), 0);
    EXPECT_LE(made.tree.share(a), 1);
    uneven =
        uneven || std::abs(made.tree.share(a) -
                           made.tree[a].shape.area / made.tree[static_cast<NodeId>(id)].shape.area) > 0.05;
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
  EXPECT_GT(share_of(tree, box.bottom, above_both(tree, box.bottom, box.top)), 0);
  made.share_out();
  EXPECT_EQ(share_of(tree, box.bottom, above_both(tree, box.bottom, box.top)), 0);
  // Half of a side's hemisphere is the floor, most of it within the sphere around the box.
  for (const NodeId side : box.sides) {
    const NodeId above = above_both(tree, side, box.top);
    EXPECT_LT(share_of(tree, side, above), 0.9 * share_of(tree, box.top, above));
    EXPECT_GT(share_of(tree, side, above), 0.2 * share_of(tree, box.top, above));
  }
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
  const std::vector<double> shares = cluster_shares(made.tree, std::vector<std::uint64_t>(made.tree.whole()));
  for (std::size_t id = 1; id < made.tree.whole(); ++id)
    EXPECT_NEAR(shares[id], made.tree.share(static_cast<NodeId>(id)), 1e-15);
}

}  // namespace
}  // namespace fluxel
