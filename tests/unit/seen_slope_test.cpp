#include "hierarchy/seen_slope.hpp"

#include <gtest/gtest.h>

#include "hierarchy/link.hpp"
#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::TreeOfScene;

class SeenSlopes : public testing::Test {
 protected:
  SeenSlopes() : made(test_scenes::random_plates(20, 0.5, Sides::two, 7)) { made.halve_some(80, 8); }

  /// The mean place of points of a face that are drawn with a density.
  template <class Density>
  glm::dvec3 mean_place(NodeId face, const Density& density) const {
    constexpr int kAlong = 120;
    glm::dvec3 places(0);
    double sum = 0;
    for (int k = 0; k < kAlong * kAlong; ++k) {
      const glm::dvec3 x =
          surface_point(tree.outline(face), (k % kAlong + 0.5) / kAlong, (k / kAlong + 0.5) / kAlong);
      const double weight = density(tree.place(face, x));
      places += weight * x;
      sum += weight;
    }
    return places / sum;
  }

  TreeOfScene made;
  const NodeTree& tree = made.tree;
};

TEST_F(SeenSlopes, OfALinearDensityIsItsSlope) {
  std::mt19937 random(1);
  for (const NodeId leaf : made.leaves()) {
    // Nowhere negative: a corner lies at both extents at most, and a triangle's nearer along one of them.
    const glm::dvec2 slope(test_scenes::uniform(random, -0.45, 0.45),
                           test_scenes::uniform(random, -0.45, 0.45));
    const glm::dvec3 at = mean_place(leaf, [&](const glm::dvec2& x) { return 1 + glm::dot(slope, x); });
    const glm::dvec2 found = seen_slope(tree, leaf, at);
    EXPECT_NEAR(found.x, slope.x, 2e-3);
    EXPECT_NEAR(found.y, slope.y, 2e-3);
  }
}

TEST_F(SeenSlopes, IsLimitedWhereAllIsInACorner) {
  double deep = 0, steep = 0;
  for (const NodeId leaf : made.leaves()) {
    const glm::dvec3 corner = tree.outline(leaf).corner[0];
    const glm::dvec2 slope = seen_slope(tree, leaf, corner);
    EXPECT_GT(glm::dot(slope, tree.place(leaf, corner)), 0.5);
    const double depth = largest_drop(tree, leaf, slope),
                 steepness = std::max(std::abs(slope.x), std::abs(slope.y));
    EXPECT_LE(depth, 1 + 1e-12);
    EXPECT_LE(steepness, kSteepest + 1e-12);
    deep = std::max(deep, depth);
    steep = std::max(steep, steepness);
  }
  EXPECT_NEAR(deep, 1, 1e-12);
  EXPECT_NEAR(steep, kSteepest, 0.5);
}

TEST_F(SeenSlopes, OfTheCentroidIsNone) {
  for (const NodeId leaf : made.leaves())
    EXPECT_NEAR(glm::length(seen_slope(tree, leaf, tree[leaf].shape.centroid)), 0, 1e-12);
}

TEST_F(SeenSlopes, LargestDropIsTheLowestPointOfTheFunction) {
  std::mt19937 random(2);
  for (const NodeId leaf : made.leaves()) {
    const glm::dvec2 slope(test_scenes::uniform(random, -3, 3), test_scenes::uniform(random, -3, 3));
    double lowest = 0;
    for (int k = 0; k < 400; ++k)
      lowest =
          std::min(lowest, glm::dot(slope, tree.place(leaf, test_scenes::random_point(tree, leaf, random))));
    EXPECT_LE(-lowest, largest_drop(tree, leaf, slope) + 1e-12);
    EXPECT_GE(-lowest, 0.7 * largest_drop(tree, leaf, slope));
  }
}

}  // namespace
}  // namespace fluxel
