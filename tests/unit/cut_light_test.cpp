#include "hierarchy/cut_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// Nodes that hold every leaf once, some of them halves of faces.
std::vector<NodeId> random_cut(NodeTree& tree, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<NodeId> open{0}, cut;
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    const bool halves = !tree.is_cluster(id) && tree[id].is_leaf() && random() % 3 == 0 && id < tree.whole();
    if (halves) tree.split(std::vector<Halving>{{id, tree.longest_edge(id)}});
    if (!tree[id].is_leaf() && (halves || id < 8 || random() % 24 != 0)) {
      open.insert(open.end(), tree[id].child.begin(), tree[id].child.end());
    } else {
      cut.push_back(id);
    }
  }
  return cut;
}

/// The number in a cut of the node that is on the way up from a face.
std::uint32_t row_above(const NodeTree& tree, const std::vector<NodeId>& cut, NodeId face) {
  std::uint32_t row = TreeCut::kNoRow;
  for (NodeId id = face; id != kNoNode; id = tree[id].parent)
    if (const auto found = std::ranges::find(cut, id); found != cut.end())
      row = static_cast<std::uint32_t>(found - cut.begin());
  return row;
}

TEST(TreeCut, KnowsTheRowOfEveryFace) {
  const Scene scene = test_scenes::random_plates(200, 0.3, Sides::two, 1);
  for (unsigned seed = 0; seed < 4; ++seed) {
    NodeTree tree(scene);
    std::vector<NodeId> nodes = random_cut(tree, seed);
    const TreeCut cut(tree, nodes, 3);
    std::ranges::sort(nodes);
    ASSERT_TRUE(std::ranges::equal(cut.nodes(), nodes));
    EXPECT_TRUE(std::ranges::any_of(nodes, [&](NodeId id) { return tree.is_cluster(id); }));
    EXPECT_TRUE(std::ranges::any_of(nodes, [&](NodeId id) { return id >= tree.whole(); }));
    std::size_t above = 0;
    for (std::size_t id = tree.clusters(); id < tree.size(); ++id) {
      const auto face = static_cast<NodeId>(id);
      const std::uint32_t expected = row_above(tree, nodes, face);
      EXPECT_EQ(cut.row_of(tree, face), expected) << face;
      EXPECT_EQ(cut.find_row(tree, face), expected) << face;
      above += expected == TreeCut::kNoRow ? 1 : 0;
    }
    EXPECT_GT(above, 0U);
    // Halves that are made afterwards.
    const std::size_t before = tree.size();
    std::vector<Halving> halvings;
    for (std::size_t id = tree.clusters(); id < before; id += 5)
      if (tree[static_cast<NodeId>(id)].is_leaf())
        halvings.push_back({static_cast<NodeId>(id), tree.longest_edge(static_cast<NodeId>(id))});
    tree.split(halvings);
    ASSERT_GT(tree.size(), before);
    for (std::size_t id = before; id < tree.size(); ++id)
      EXPECT_EQ(cut.row_of(tree, static_cast<NodeId>(id)), row_above(tree, nodes, static_cast<NodeId>(id)));
  }
}

// Of a cluster each face has the part of the cube's sides that its normal says.
TEST(CutLight, IsThatOfTheNodeByTheNormal) {
  const Scene scene = test_scenes::random_plates(60, 0.3, Sides::one, 2);
  const NodeTree tree(scene);
  const TreeCut cut(tree, {0}, 1);
  ASSERT_EQ(cut.unknowns(), kCubeSides);
  const std::vector<Rgb> irradiance{Rgb(1), Rgb(2), Rgb(3), Rgb(4), Rgb(5), Rgb(6)};
  const CutLight light(tree, cut, irradiance, {});
  for (std::size_t id = tree.clusters(); id < tree.size(); ++id) {
    const glm::dvec3 n = tree[static_cast<NodeId>(id)].shape.normal;
    const double expected =
        n.x * n.x * (n.x < 0 ? 2 : 1) + n.y * n.y * (n.y < 0 ? 4 : 3) + n.z * n.z * (n.z < 0 ? 6 : 5);
    EXPECT_NEAR(light.irradiance(static_cast<NodeId>(id)).g, expected, 1e-12);
    EXPECT_NEAR(light.reflected(static_cast<NodeId>(id)).g,
                tree.material(static_cast<NodeId>(id)).rho.g * expected, 1e-12);
  }
}

TEST(LeafCut, HasTheLightOfEveryLeaf) {
  const Scene scene = test_scenes::random_plates(60, 0.3, Sides::two, 3);
  NodeTree tree(scene);
  random_cut(tree, 5);
  const LeafUnknowns leaves(tree);
  std::vector<Rgb> H;
  for (std::size_t k = 0; k < leaves.nodes().size(); ++k)
    H.emplace_back(static_cast<double>(k) + Rgb(1, 2, 3));
  const LeafCut cut(tree, leaves, H, 2);
  const CutLight light = cut.light();
  ASSERT_EQ(light.cut().nodes().size(), tree.leaves());
  for (std::size_t k = 0; k < H.size(); ++k) {
    const NodeId leaf = leaves.nodes()[k];
    if (leaf == kNoNode) continue;
    EXPECT_EQ(light.irradiance(leaf), H[k]);
    const Rgb reflected = tree.material(leaf).rho * H[k];
    EXPECT_NEAR(light.reflected_powers()[light.cut().row_of(tree, leaf)],
                (reflected.r + reflected.g + reflected.b) / 3 * tree[leaf].shape.area, 1e-12);
  }
}

}  // namespace
}  // namespace fluxel
