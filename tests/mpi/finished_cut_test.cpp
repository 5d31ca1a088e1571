#include "method/finished_cut.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// A cut of clusters, faces and halves through plates of two sides, with the light that its nodes reflect.
struct LitPlates {
  Scene scene = test_scenes::random_plates(40, 0.5, Sides::two, 3);
  NodeTree tree{scene};
  TreeCut cut;
  std::vector<Rgb> irradiance;
  std::vector<double> powers;

  LitPlates() {
    const NodeId halved = tree.face(0, true);
    tree.split(std::vector<Halving>{{halved, tree.longest_edge(halved)}});
    std::vector<NodeId> open{0}, nodes;
    while (!open.empty()) {
      const NodeId id = open.back();
      open.pop_back();
      const bool holds_half = tree.is_cluster(id) || id == halved;
      if (!tree[id].is_leaf() && holds_half && (id == halved || tree[id].shape.area > 2)) {
        open.insert(open.end(), tree[id].child.begin(), tree[id].child.end());
      } else {
        nodes.push_back(id);
      }
    }
    cut = TreeCut(tree, nodes, 1);
    for (std::size_t k = 0; k < cut.unknowns(); ++k)
      irradiance.emplace_back(1.0 + static_cast<double>(k % 7));
    for (std::size_t row = 0; row < nodes.size(); ++row) powers.push_back(1.0 + static_cast<double>(row));
  }
};

// The density is one of points: over all sides it sums to 1, and it is how often they are drawn.
TEST(FinishedCut, DrawsByItsDensity) {
  const LitPlates lit;
  const FinishedCut finished(lit.tree, CutLight(lit.tree, lit.cut, lit.irradiance, lit.powers));
  double sum = 0;
  for (std::size_t id = lit.tree.clusters(); id < lit.tree.size(); ++id) {
    const Node& node = lit.tree[static_cast<NodeId>(id)];
    if (!node.is_leaf()) continue;
    const PatchId patch = lit.scene.pieces[node.piece].patch;
    sum += node.shape.area * finished.density(patch, node.front, node.shape.centroid);
    EXPECT_EQ(finished.reflected(patch, node.front, node.shape.centroid),
              lit.tree.material(static_cast<NodeId>(id)).rho *
                  lit.cut.part(lit.cut.row_of(lit.tree, static_cast<NodeId>(id)), node.shape.normal,
                               std::span<const Rgb>(lit.irradiance)));
  }
  EXPECT_NEAR(sum, 1, 1e-9);
  // 1 / density over draws is the area that can be drawn, in the mean.
  constexpr int kDraws = 1 << 14;
  SobolPoints points(1);
  double area = 0;
  std::map<bool, int> sides;
  for (int k = 0; k < kDraws; ++k) {
    const auto [u, v, unused, other] = points.next();
    const std::optional<DrawnPoint> drawn = finished.draw(u, v);
    ASSERT_TRUE(drawn);
    ++sides[drawn->front];
    const double density = finished.density(drawn->patch, drawn->front, drawn->position);
    ASSERT_GT(density, 0);
    area += 1 / (density * kDraws);
  }
  EXPECT_NEAR(area, lit.tree[0].shape.area, 0.02 * lit.tree[0].shape.area);
  EXPECT_EQ(sides.size(), 2U);
}

}  // namespace
}  // namespace fluxel
