#include "hierarchy/node_tree.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "subdivision/bisection.hpp"
#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::TreeOfScene;

void expect_same_corners(const Outline3& a, const Outline3& b) {
  ASSERT_EQ(a.corners, b.corners);
  for (std::uint32_t c = 0; c < a.corners; ++c) EXPECT_EQ(a.corner[c], b.corner[c]);
}

class NodeTrees : public testing::TestWithParam<Sides> {
 protected:
  NodeTrees() : made(test_scenes::random_plates(20, 0.5, GetParam(), 7)) { made.halve_some(80, 8); }

  TreeOfScene made;
  const NodeTree& tree = made.tree;
};

TEST_P(NodeTrees, ChildrenComeAfterTheirParentAndMakeItUp) {
  double leaves = 0;
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    const Node& node = tree[id];
    if (id == 0) {
      EXPECT_EQ(node.parent, kNoNode);
    }
    if (node.is_leaf()) {
      EXPECT_FALSE(tree.is_cluster(id));
      leaves += node.shape.area;
      continue;
    }
    double area = 0;
    glm::dvec3 first_moment(0), normals(0);
    for (const NodeId child : node.child) {
      EXPECT_GT(child, id);
      EXPECT_EQ(tree[child].parent, id);
      area += tree[child].shape.area;
      first_moment += tree[child].shape.area * tree[child].shape.centroid;
      normals += tree[child].shape.area * tree[child].shape.normal;
      if (tree.is_cluster(id)) continue;
      EXPECT_EQ(tree[child].piece, node.piece);
      EXPECT_EQ(tree[child].front, node.front);
    }
    EXPECT_NEAR(area, node.shape.area, 1e-12);
    EXPECT_NEAR(glm::distance(first_moment / area, node.shape.centroid), 0, 1e-12);
    EXPECT_NEAR(glm::distance(normals / area, node.shape.normal), 0, 1e-12);
  }
  EXPECT_NEAR(leaves, tree[0].shape.area, 1e-9);
}

TEST_P(NodeTrees, CovarianceIsThatOfPlaces) {
  std::mt19937 random(9);
  for (const NodeId leaf : made.leaves()) {
    constexpr int kPoints = 4000;
    glm::dmat2 sum(0);
    for (int k = 0; k < kPoints; ++k) {
      const glm::dvec2 x = tree.place(leaf, test_scenes::random_point(tree, leaf, random));
      sum += glm::outerProduct(x, x) / double{kPoints};
    }
    const glm::dmat2 covariance = tree.covariance(leaf);
    for (int c = 0; c < 2; ++c)
      for (int r = 0; r < 2; ++r) EXPECT_NEAR(covariance[c][r], sum[c][r], 0.02);
  }
}

TEST_P(NodeTrees, TheLeafBelowHoldsThePoint) {
  std::mt19937 random(10);
  for (const NodeId leaf : made.leaves()) {
    NodeId whole = leaf;
    while (tree[whole].parent != kNoNode && !tree.is_cluster(tree[whole].parent)) whole = tree[whole].parent;
    for (int k = 0; k < 20; ++k)
      EXPECT_EQ(tree.leaf_below(whole, test_scenes::random_point(tree, leaf, random)), leaf);
  }
  EXPECT_EQ(tree.leaf_below(kNoNode, glm::dvec3(0)), kNoNode);
}

TEST_P(NodeTrees, SpheresAndMomentsHoldWhatIsBelow) {
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    // The mean squared distance of the leaves' points from the node's centroid.
    double squares = 0;
    for (const NodeId leaf : made.leaves()) {
      if (!test_scenes::is_within(tree, leaf, id)) continue;
      const Outline3& outline = tree.outline(leaf);
      for (std::uint32_t c = 0; c < outline.corners; ++c)
        EXPECT_LE(glm::distance(outline.corner[c], tree[id].shape.centroid), tree[id].radius * (1 + 1e-12));
      const glm::dvec3 d = tree[leaf].shape.centroid - tree[id].shape.centroid;
      squares += tree[leaf].shape.area * (tree[leaf].shape.moments.trace() + glm::dot(d, d));
    }
    EXPECT_NEAR(squares / tree[id].shape.area, tree[id].shape.moments.trace(), 1e-12);
  }
}

TEST_P(NodeTrees, TwinsAreTheSamePartFromTheOtherSide) {
  std::size_t twins = 0;
  for (std::size_t k = tree.clusters(); k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    const Node& node = tree[id];
    EXPECT_NEAR(glm::distance(area_vector(corners(tree.outline(id))), node.shape.area * node.shape.normal), 0,
                1e-12);
    if (node.twin == kNoNode) continue;
    ++twins;
    const Node& twin = tree[node.twin];
    EXPECT_EQ(twin.twin, id);
    EXPECT_EQ(twin.piece, node.piece);
    EXPECT_NE(twin.front, node.front);
    EXPECT_EQ(twin.is_leaf(), node.is_leaf());
    Outline3 turned = tree.outline(node.twin);
    std::reverse(turned.corner.begin(), turned.corner.begin() + turned.corners);
    expect_same_corners(turned, tree.outline(id));
    if (node.is_leaf()) continue;
    for (std::size_t half = 0; half < 2; ++half) EXPECT_EQ(tree[node.child[half]].twin, twin.child[half]);
  }
  EXPECT_EQ(twins, GetParam() == Sides::two ? tree.size() - tree.clusters() : 0);
}

TEST_P(NodeTrees, ThePointsOfAChildAreInIt) {
  std::mt19937 random(9);
  std::size_t asked = 0;
  for (std::size_t k = tree.clusters(); k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    if (tree[id].is_leaf()) continue;
    for (std::size_t half = 0; half < 2; ++half) {
      for (int point = 0; point < 20; ++point, ++asked)
        EXPECT_EQ(tree.in_first_child(id, test_scenes::random_point(tree, tree[id].child[half], random)),
                  half == 0);
    }
  }
  EXPECT_GT(asked, 1000U);
}

TEST_P(NodeTrees, PlacesAreFromTheCentroidOverTheExtents) {
  for (std::size_t k = tree.clusters(); k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    const PlaneAxes& axes = tree.axes(id);
    EXPECT_NEAR(glm::dot(axes.u, axes.v), 0, 1e-12);
    EXPECT_NEAR(glm::dot(axes.u, tree[id].shape.normal), 0, 1e-12);
    EXPECT_NEAR(glm::length(axes.v), 1, 1e-12);
    if (tree[id].is_leaf()) continue;
    for (const NodeId child : tree[id].child) {
      const glm::dvec2 offset = tree[id].extent * tree.place(id, tree[child].shape.centroid);
      const glm::dvec3 reached = tree[id].shape.centroid + offset.x * axes.u + offset.y * axes.v;
      EXPECT_NEAR(glm::distance(reached, tree[child].shape.centroid), 0, 1e-12);
    }
  }
}

TEST_P(NodeTrees, ARandomFaceHasAChanceOfItsArea) {
  constexpr int kDraws = 200000;
  std::map<NodeId, int> drawn;
  std::map<NodeId, double> left;
  for (int k = 0; k < kDraws; ++k) {
    double u = (k + 0.5) / kDraws;
    const NodeId face = tree.random_face(0, u);
    ASSERT_TRUE(u >= 0 && u < 1);
    ++drawn[face];
    left[face] += u;
  }
  double area = 0;
  for (const auto& [face, times] : drawn) {
    EXPECT_FALSE(tree.is_cluster(face));
    EXPECT_TRUE(tree.is_cluster(tree[face].parent));
    EXPECT_NEAR(times, kDraws * tree[face].shape.area / tree[0].shape.area, 1);
    EXPECT_NEAR(left[face] / times, 0.5, 1e-3);  // what is left of u is even again
    area += tree[face].shape.area;
  }
  EXPECT_NEAR(area, tree[0].shape.area, 1e-9);
  double same = 0.25;
  EXPECT_EQ(tree.random_face(drawn.begin()->first, same), drawn.begin()->first);
  EXPECT_EQ(same, 0.25);
}

TEST_P(NodeTrees, AFaceIsDrawnWithTheChanceThatItSays) {
  constexpr int kDraws = 200000;
  std::map<NodeId, int> drawn;
  std::map<NodeId, double> chance, left;
  const glm::dvec3 from = tree[tree.face(3, true)].shape.centroid;
  for (int k = 0; k < kDraws; ++k) {
    double u = (k + 0.5) / kDraws;
    const DrawnFace face = tree.draw_face(0, from, u);
    ASSERT_TRUE(u >= 0 && u < 1);
    ++drawn[face.face];
    left[face.face] += u;
    chance[face.face] = face.chance;
  }
  double sum = 0;
  for (const auto& [face, times] : drawn) {
    EXPECT_FALSE(tree.is_cluster(face));
    EXPECT_NEAR(times, kDraws * chance[face], 1);
    EXPECT_NEAR(left[face] / times, 0.5, 1e-2);
    sum += chance[face];
  }
  EXPECT_NEAR(sum, 1, 1e-9);
  double same = 0.25;
  EXPECT_EQ(tree.draw_face(drawn.begin()->first, from, same).face, drawn.begin()->first);
  EXPECT_EQ(same, 0.25);
}

TEST(NodeTree, NearFacesAreDrawnMoreOftenThanByTheirAreas) {
  const TreeOfScene made(test_scenes::random_plates(200, 0.02, Sides::one, 9));
  const glm::dvec3 from = made.tree[made.tree.face(3, true)].shape.centroid;
  constexpr int kDraws = 10000;
  double by_size = 0, by_area = 0;
  for (int k = 0; k < kDraws; ++k) {
    double u = (k + 0.5) / kDraws, same = u;
    by_size += glm::distance(made.tree[made.tree.draw_face(0, from, u).face].shape.centroid, from);
    by_area += glm::distance(made.tree[made.tree.random_face(0, same)].shape.centroid, from);
  }
  EXPECT_LT(by_size, 0.8 * by_area);
}

TEST_P(NodeTrees, TheNumbersDependOnTheStepsAlone) {
  TreeOfScene other(test_scenes::random_plates(20, 0.5, GetParam(), 7));
  other.halve_some(80, 8);
  ASSERT_EQ(other.tree.size(), tree.size());
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    EXPECT_EQ(other.tree[id].child, tree[id].child);
    if (!tree.is_cluster(id)) expect_same_corners(other.tree.outline(id), tree.outline(id));
  }
}

TEST_P(NodeTrees, ElementsAreThoseOfSubdivisionInItsOrder) {
  TreeOfScene fresh(made.scene);
  constexpr double kMaxEdge = 0.2;
  for (;;) {
    std::vector<NodeId> long_ones;
    for (const NodeId leaf : fresh.leaves())
      if (is_longer(longest_edge(fresh.tree.outline(leaf)), kMaxEdge)) long_ones.push_back(leaf);
    if (long_ones.empty()) break;
    fresh.halve(long_ones);
  }
  const ElementMesh mesh = fresh.tree.elements();
  const ElementMesh expected = test_scenes::uniform_elements(made.scene, kMaxEdge);
  ASSERT_EQ(mesh.elements.size(), expected.elements.size());
  ASSERT_GT(mesh.elements.size(), 3 * made.scene.pieces.size());
  EXPECT_EQ(
      std::memcmp(mesh.elements.data(), expected.elements.data(), mesh.elements.size() * sizeof(Element)), 0);
  EXPECT_EQ(std::memcmp(mesh.outlines.data(), expected.outlines.data(),
                        mesh.outlines.size() * sizeof(Outline<glm::vec3>)),
            0);
  const std::vector<ElementNodes> nodes = fresh.tree.element_nodes();
  ASSERT_EQ(nodes.size(), mesh.elements.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    ASSERT_NE(nodes[k].front, kNoNode);
    EXPECT_TRUE(fresh.tree[nodes[k].front].front);
    EXPECT_EQ(fresh.tree[nodes[k].front].twin, nodes[k].back);
    EXPECT_EQ(glm::vec3(fresh.tree[nodes[k].front].shape.centroid), mesh.elements[k].centroid);
  }
}

INSTANTIATE_TEST_SUITE_P(Sides, NodeTrees, testing::Values(Sides::one, Sides::two),
                         [](const auto& at) { return at.param == Sides::two ? "two" : "one"; });

TEST(NodeTree, SealedSidesHaveNoFaces) {
  Scene scene = test_scenes::random_plates(4, 0.5, Sides::one, 3);
  scene.patches[1].sides = 0;
  scene.patches[2].sides = kBack;
  scene.patches[3].sides = kFront | kBack;
  TreeOfScene made(std::move(scene));
  made.halve_all(1);
  const NodeTree& tree = made.tree;
  EXPECT_EQ(tree.face(0, false), kNoNode);
  EXPECT_EQ(tree.face(1, true), kNoNode);
  EXPECT_EQ(tree.face(1, false), kNoNode);
  EXPECT_EQ(tree.face(2, true), kNoNode);
  EXPECT_EQ(tree[tree.face(3, true)].twin, tree.face(3, false));
  const ElementMesh mesh = tree.elements();
  const std::vector<ElementNodes> nodes = tree.element_nodes();
  ASSERT_EQ(mesh.elements.size(), 7U);  // the piece without faces stays whole
  ASSERT_EQ(nodes.size(), 7U);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::uint32_t sides = mesh.elements[k].sides;
    EXPECT_EQ(nodes[k].front != kNoNode, (sides & kFront) != 0) << k;
    EXPECT_EQ(nodes[k].back != kNoNode, (sides & kBack) != 0) << k;
    for (const NodeId id : {nodes[k].front, nodes[k].back}) {
      if (id == kNoNode) continue;
      EXPECT_EQ(glm::vec3(tree[id].shape.centroid), mesh.elements[k].centroid);
      EXPECT_EQ(tree[id].front, id == nodes[k].front);
    }
  }
  // An element's outline is counter-clockwise about its patch's normal, whichever side is an unknown.
  for (std::size_t k = 0; k < nodes.size(); ++k)
    EXPECT_GT(glm::dot(area_vector(corners(widen(mesh.outlines[k]))),
                       made.scene.patch(mesh.elements[k].patch).normal),
              0);
}

TEST(NodeTree, ScenesOfOneFaceAndOfNone) {
  TreeOfScene one(test_scenes::unit_square(Sides::one));
  EXPECT_EQ(one.tree.size(), 1U);
  EXPECT_EQ(one.tree.clusters(), 0U);
  EXPECT_EQ(one.tree.face(0, true), 0U);
  TreeOfScene two(test_scenes::unit_square(Sides::two));
  EXPECT_EQ(two.tree.size(), 3U);
  EXPECT_EQ(two.tree.clusters(), 1U);
  EXPECT_NEAR(glm::length(two.tree[0].shape.normal), 0, 1e-15);
  Scene sealed = test_scenes::unit_square(Sides::one);
  sealed.patches[0].sides = 0;
  const TreeOfScene none(std::move(sealed));
  EXPECT_EQ(none.tree.size(), 0U);
  EXPECT_EQ(none.tree.elements().elements.size(), 1U);
}

TEST(NodeTree, ATwinThatIsNamedTooIsHalvedOnce) {
  TreeOfScene made(test_scenes::unit_square(Sides::two));
  made.halve(std::vector<NodeId>{1, 2});
  EXPECT_EQ(made.tree.size(), 7U);
}

}  // namespace
}  // namespace fluxel
