#include "hierarchy/linked_nodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::TreeOfScene;

/// Plates in clusters, some of them halved.
class LinkedNodesOfPlates : public testing::Test {
 protected:
  LinkedNodesOfPlates() : made(test_scenes::random_plates(40, 0.2, Sides::two, 2)) {
    made.halve_some(30, 5);
    made.share_out();
  }

  [[nodiscard]] LinkedNodes linked_by(const std::vector<NodeId>& with_links) const {
    std::vector<std::uint64_t> has_links(made.tree.size());
    for (const NodeId id : with_links) has_links[id] = 3;
    return {made.tree, leaves(), has_links};
  }

  [[nodiscard]] LeafUnknowns leaves() const { return LeafUnknowns(made.tree); }

  /// A face that has been halved.
  [[nodiscard]] NodeId halved_face() const {
    for (std::size_t id = made.tree.clusters(); id < made.tree.whole(); ++id)
      if (!made.tree[static_cast<NodeId>(id)].is_leaf()) return static_cast<NodeId>(id);
    ADD_FAILURE() << "none";
    return kNoNode;
  }

  /// How often each unknown stands there, as a leaf of its own or in a bundle.
  [[nodiscard]] std::vector<int> times_reached(const LinkedNodes& linked) const {
    std::vector<int> times(leaves().nodes().size());
    for (const LinkedNode& node : linked.nodes()) {
      if (node.unknown != LinkedNode::kNone) ++times[node.unknown];
      for (const BundledLeaf& leaf : linked.leaves_of(node)) ++times[leaf.unknown];
    }
    return times;
  }

  TreeOfScene made;
};

TEST_F(LinkedNodesOfPlates, WithoutLinksBelowTheRootIsABundle) {
  const LinkedNodes linked = linked_by({0});
  ASSERT_EQ(linked.nodes().size(), 1U);
  EXPECT_EQ(linked.clusters(), 1U);
  const std::span<const BundledLeaf> bundle = linked.leaves_of(linked.nodes()[0]);
  EXPECT_EQ(bundle.size(), made.leaves().size());
  const LeafUnknowns of_leaves = leaves();
  WayShares sums{};
  for (const BundledLeaf& leaf : bundle) {
    const FlatShape& shape = made.tree[of_leaves.nodes()[leaf.unknown]].shape;
    EXPECT_NEAR(made.tree[0].shape.area / leaf.cluster_over_face * leaf.part_of_face, shape.area, 1e-12);
    for (std::size_t way = 0; way < kWays; ++way) sums[way] += leaf.part_of_face * leaf.shares[way];
  }
  for (const double sum : sums) EXPECT_NEAR(sum, 1, 1e-12);
}

TEST_F(LinkedNodesOfPlates, ALinkOpensTheWayToItsNodeAndNoFurther) {
  const NodeId face = halved_face();
  NodeId cluster = made.tree[face].parent;
  const LinkedNodes linked = linked_by({cluster});
  EXPECT_NE(linked.place(cluster), LinkedNode::kNone);
  EXPECT_EQ(linked.place(face), LinkedNode::kNone);
  const LinkedNodes deeper = linked_by({face});
  EXPECT_NE(deeper.place(face), LinkedNode::kNone);
  for (const NodeId half : made.tree[face].child) EXPECT_NE(deeper.place(half), LinkedNode::kNone);
  std::size_t depth = 0;
  for (; cluster != kNoNode; cluster = made.tree[cluster].parent) ++depth;
  EXPECT_LE(deeper.clusters(), 2 * depth);
  EXPECT_LT(deeper.nodes().size(), made.tree.size() / 2);
}

TEST_F(LinkedNodesOfPlates, EveryLeafIsReachedOnce) {
  std::mt19937 random(6);
  for (const std::size_t count : {0U, 1U, 5U, 40U}) {
    std::vector<NodeId> with_links;
    for (std::size_t k = 0; k < count; ++k)
      with_links.push_back(static_cast<NodeId>(random() % made.tree.size()));
    const LinkedNodes linked = linked_by(with_links);
    const std::vector<int> times = times_reached(linked);
    const LeafUnknowns of_leaves = leaves();
    for (std::size_t k = 0; k < times.size(); ++k)
      EXPECT_EQ(times[k], of_leaves.nodes()[k] == kNoNode ? 0 : 1) << k << " of " << count;
    EXPECT_TRUE(std::ranges::is_sorted(linked.nodes(), {}, &LinkedNode::id));
    for (const LinkedNode& node : linked.nodes()) {
      for (const std::uint32_t child : node.child) {
        if (child == LinkedNode::kNone) continue;
        EXPECT_EQ(made.tree[linked.nodes()[child].id].parent, node.id);
      }
    }
  }
}

}  // namespace
}  // namespace fluxel
