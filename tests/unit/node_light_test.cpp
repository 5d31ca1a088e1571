#include "hierarchy/node_light.hpp"

#include <gtest/gtest.h>

#include "hierarchy/face_pair.hpp"
#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::RefinedTree;
using test_scenes::TreeOfScene;

double grey(const Rgb& x) { return (x.r + x.g + x.b) / kChannels; }

TEST(LeafUnknowns, AreTheSidesOfTheElements) {
  Scene scene = test_scenes::random_plates(12, 0.4, Sides::two, 1);
  scene.patches[3].sides = kBack;
  scene.patches[4].sides = 0;
  TreeOfScene made(std::move(scene));
  made.halve_some(20, 2);
  const LeafUnknowns leaves(made.tree);
  const std::size_t elements = made.tree.elements().elements.size();
  ASSERT_EQ(leaves.unknowns().size(), 2 * elements);
  ASSERT_EQ(leaves.nodes().size(), 2 * elements);
  std::size_t sides = 0;
  for (std::size_t k = 0; k < leaves.nodes().size(); ++k) {
    const NodeId id = leaves.nodes()[k];
    EXPECT_EQ(id == kNoNode, leaves.unknowns().area[k] == 0);
    if (id == kNoNode) continue;
    ++sides;
    EXPECT_TRUE(made.tree[id].is_leaf());
    EXPECT_EQ(made.tree[id].front, k < elements);
    EXPECT_NEAR(made.tree[id].shape.area, leaves.unknowns().area[k], 1e-6);
  }
  EXPECT_EQ(sides, made.leaves().size());
  EXPECT_EQ(sides, leaves.unknowns().active);
}

TEST(NodeLight, MeansAndDeviationsOverEveryNode) {
  TreeOfScene made(test_scenes::random_plates(12, 0.4, Sides::two, 3));
  made.halve_some(60, 4);
  const LeafUnknowns leaves(made.tree);
  std::mt19937 random(5);
  std::vector<Rgb> B(leaves.unknowns().size());
  for (Rgb& value : B) value = test_scenes::uniform_point(random, 0, 1);
  std::vector<Rgb> means(made.tree.size(), Rgb(0));
  for (std::size_t k = 0; k < B.size(); ++k) means[leaves.nodes()[k]] = B[k];
  pull(made.tree, std::span(means));
  const std::vector<NodeLight> light = light_of_nodes(made.tree, leaves, B, {});
  ASSERT_EQ(light.size(), made.tree.size());
  for (std::size_t id = 0; id < light.size(); ++id) {
    Rgb sum(0);
    double area = 0, squares = 0;
    for (std::size_t k = 0; k < B.size(); ++k) {
      if (!test_scenes::is_within(made.tree, leaves.nodes()[k], static_cast<NodeId>(id))) continue;
      const double part = made.tree[leaves.nodes()[k]].shape.area;
      area += part;
      sum += part * B[k];
      squares += part * grey(B[k]) * grey(B[k]);
    }
    const double mean = grey(sum) / area;
    EXPECT_NEAR(glm::distance(means[id], sum / area), 0, 1e-12);
    EXPECT_NEAR(light[id].B, mean, 1e-6);
    EXPECT_NEAR(light[id].deviation, std::sqrt(std::max(0.0, squares / area - mean * mean)), 1e-5);
    EXPECT_NEAR(light[id].rho, 0.5, 1e-6);
    EXPECT_EQ(light[id].importance, 1);
  }
}

TEST(NodeLight, SlopesSpreadALeafAsTheyWouldItsPoints) {
  TreeOfScene made(test_scenes::unit_square(Sides::one));
  const LeafUnknowns whole(made.tree);
  // An irradiance that rises by 3 along a side; rho 0.5.
  const glm::dvec2 extent = made.tree[0].extent;
  std::vector<std::array<Rgb, 2>> slopes{{Rgb(3 * extent.x), Rgb(0)}};
  const std::vector<Rgb> B{Rgb(1)};
  const double expected = 0.5 * 3 / std::sqrt(12.0);
  EXPECT_NEAR(light_of_nodes(made.tree, whole, B, slopes)[0].deviation, expected, 1e-6);
  slopes[0] = {Rgb(0), Rgb(3 * extent.y)};
  EXPECT_NEAR(light_of_nodes(made.tree, whole, B, slopes)[0].deviation, expected, 1e-6);

  // The same line in four quarters.
  made.halve_all(2);
  const LeafUnknowns quarters(made.tree);
  std::vector<Rgb> of_quarters;
  slopes.clear();
  for (const NodeId id : quarters.nodes()) {
    const glm::dvec3 d = made.tree[id].shape.centroid - made.tree[0].shape.centroid;
    of_quarters.push_back(Rgb(1 + 0.5 * 3 * glm::dot(d, made.tree.axes(0).u)));
    slopes.push_back({Rgb(3 * made.tree[id].extent.x), Rgb(0)});
  }
  const std::vector<NodeLight> light = light_of_nodes(made.tree, quarters, of_quarters, slopes);
  EXPECT_NEAR(light[0].B, 1, 1e-6);
  EXPECT_NEAR(light[0].deviation, expected, 1e-6);
}

TEST(NodeLight, BendsAddUpOverPartsOfTheLinks) {
  const RefinedTree made(test_scenes::room_with_box(), 1e-2);
  const std::vector<NodeLight> light = test_scenes::even_light(made.tree);
  constexpr double kUnit = 0x1p-16;
  std::vector<std::uint64_t> whole(made.tree.size()), parts(made.tree.size());
  add_squared_residuals(made.tree, made.links, light, made.epsilon(), kUnit, whole);
  for (std::size_t k = made.links.size(); k-- > 0;)
    add_squared_residuals(made.tree, std::span(made.links).subspan(k, 1), light, made.epsilon(), kUnit,
                          parts);
  EXPECT_EQ(whole, parts);
  std::vector<NodeLight> bent = light;
  add_to_deviation(made.tree, whole, kUnit, bent);
  std::size_t more = 0;
  for (std::size_t id = 0; id < light.size(); ++id) {
    const NodeId node = static_cast<NodeId>(id);
    if (made.tree.is_cluster(node) || !made.tree[node].is_leaf()) {
      EXPECT_EQ(whole[id], 0U);
      EXPECT_EQ(bent[id].deviation, light[id].deviation);
      continue;
    }
    double squared = 0;
    for (const Link& link : made.links) {
      if (link.p != node && link.q != node) continue;
      const FacePair pair = estimate_face_pair(made.tree, link.p, link.q, made.epsilon());
      const double residual = link.p == node ? pair.p.residual : pair.q.residual;
      const double deviation =
          0.5 * 0.5 * static_cast<double>(link.G) * residual / (made.tree[node].shape.area * pair.G);
      squared += deviation * deviation;
    }
    EXPECT_NEAR(bent[id].deviation, std::sqrt(0.04 + squared), 1e-4);
    more += bent[id].deviation > light[id].deviation ? 1 : 0;
  }
  EXPECT_GT(more, 20U);
}

TEST(NodeLight, SlopesOfLeavesAreReflectedAndTurnNoSign) {
  TreeOfScene made(test_scenes::random_plates(12, 0.4, Sides::two, 3));
  made.halve_some(20, 4);
  const LeafUnknowns leaves(made.tree);
  std::mt19937 random(6);
  const std::size_t n = leaves.unknowns().size();
  std::vector<Rgb> B(n);
  std::vector<std::array<Rgb, 2>> of_irradiance(n);
  for (std::size_t k = 0; k < n; ++k) {
    B[k] = test_scenes::uniform_point(random, -0.5, 1);
    of_irradiance[k] = {test_scenes::uniform_point(random, -1, 1), test_scenes::uniform_point(random, -1, 1)};
  }
  const auto slopes = slopes_of_leaves(made.tree, leaves, B, of_irradiance);
  std::size_t kept = 0, limited = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const NodeId id = leaves.nodes()[k];
    const Outline<glm::dvec3>& outline = made.tree.outline(id);
    for (int c = 0; c < kChannels; ++c) {
      const glm::dvec2 full =
          leaves.unknowns().rho[k][c] * glm::dvec2(of_irradiance[k][0][c], of_irradiance[k][1][c]);
      const glm::dvec2 slope(slopes[k][0][c], slopes[k][1][c]);
      double least = B[k][c] < 0 ? -B[k][c] : B[k][c], full_least = least;
      for (std::uint32_t corner = 0; corner < outline.corners; ++corner) {
        const glm::dvec2 x = made.tree.place(id, outline.corner[corner]);
        const double sign = B[k][c] < 0 ? -1 : 1;
        least = std::min(least, sign * (B[k][c] + glm::dot(slope, x)));
        full_least = std::min(full_least, sign * (B[k][c] + glm::dot(full, x)));
      }
      EXPECT_GE(least, -1e-12);
      EXPECT_NEAR(slope.x * full.y, slope.y * full.x, 1e-12);
      if (full_least >= 0) {
        EXPECT_NEAR(glm::distance(slope, full), 0, 1e-12);
        ++kept;
      } else {
        EXPECT_NEAR(least, 0, 1e-12);
        ++limited;
      }
    }
  }
  EXPECT_GT(kept, 10U);
  EXPECT_GT(limited, 10U);
}

}  // namespace
}  // namespace fluxel
