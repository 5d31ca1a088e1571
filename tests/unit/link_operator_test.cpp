#include "hierarchy/link_operator.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>

#include "hierarchy/node_light.hpp"
#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::RefinedTree;

const SumOverRanks kAlone = [](std::span<std::uint64_t>) {};

/// Links as a matrix over the leaves, and as an operator.
struct Matrix {
  explicit Matrix(const RefinedTree& of)
      : made(of), leaves(of.tree), table(of.tree, of.links), linked(of.tree, leaves, has_links(of)) {}

  static std::vector<std::uint64_t> has_links(const RefinedTree& of) {
    std::vector<std::uint64_t> has(of.tree.size());
    for (const Link& link : of.links) has[link.p] = has[link.q] = 1;
    return has;
  }

  /// F between leaves of the nodes of a link: its kernel is linear over both.
  [[nodiscard]] double entry(NodeId to, NodeId receiver, NodeId from, const LinkEnd& end) const {
    const auto along = [&](NodeId leaf, NodeId node, const Slope& slope) {
      if (made.tree.is_cluster(node)) return 0.0;
      const glm::dvec2 at = made.tree.place(node, made.tree[leaf].shape.centroid);
      return (slope.u * at.x + slope.v * at.y) / kSlopeOne;
    };
    return static_cast<double>(end.F) * share(to, receiver, end.from) * made.tree[receiver].shape.area /
           made.tree[to].shape.area * (1 + along(to, receiver, end.here)) * share(from, end.from, receiver) *
           (1 + along(from, end.from, end.there));
  }

  /// Of what the node exchanges with another, at equal densities over faces.
  [[nodiscard]] double share(NodeId leaf, NodeId node, NodeId other) const {
    const WayParts ways = way_parts(made.tree[other].shape.centroid - made.tree[node].shape.centroid);
    double sum = 0;
    for (std::size_t k = 0; k < ways.way.size(); ++k) {
      double product = ways.part[k];
      for (NodeId id = leaf; id != node; id = made.tree[id].parent)
        product *= made.tree.is_cluster(made.tree[id].parent) ? made.tree.shares(id)[ways.way[k]] : 0.5;
      sum += product;
    }
    return sum;
  }

  [[nodiscard]] std::vector<std::vector<double>> dense() const {
    const NodeTree& tree = made.tree;
    const std::size_t n = leaves.nodes().size();
    std::vector<std::vector<double>> F(n, std::vector<double>(n));
    for (std::size_t i = 0; i < n; ++i) {
      const NodeId to = leaves.nodes()[i];
      for (NodeId receiver = to; receiver != kNoNode; receiver = tree[receiver].parent)
        for (const LinkEnd& end : table.of(receiver))
          for (std::size_t j = 0; j < n; ++j)
            if (test_scenes::is_within(tree, leaves.nodes()[j], end.from))
              F[i][j] += entry(to, receiver, leaves.nodes()[j], end);
    }
    return F;
  }

  [[nodiscard]] LinkOperator F() const { return {linked, table, kAlone, 1}; }

  const RefinedTree& made;
  LeafUnknowns leaves;
  LinkTable table;
  LinkedNodes linked;
};

std::vector<Rgb> random_values(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Rgb> values(count);
  for (Rgb& value : values) value = test_scenes::uniform_point(random, -1, 1);
  return values;
}

class LinkOperators : public testing::Test {
 protected:
  LinkOperators()
      : made(test_scenes::room_with_box(), 1e-2),
        plates(test_scenes::random_plates(40, 0.2, Sides::two, 2), 1e-2),
        coarse(test_scenes::random_plates(40, 0.2, Sides::two, 2), 0.3) {
    // So that nodes of links have leaves below them.
    made.halve_some(60, 3);
    plates.halve_some(60, 4);
    plates.share_out();
    coarse.halve_some(60, 4);
    coarse.share_out();
  }

  RefinedTree made, plates, coarse;  // the second has clusters, the third few others with links
};

TEST_F(LinkOperators, EveryLinkIsALinkOfBoth) {
  for (const RefinedTree* of : {&made, &plates}) {
    const LinkTable table(of->tree, of->links);
    const auto within = std::ranges::count_if(of->links, [](const Link& link) { return link.p == link.q; });
    EXPECT_EQ(table.size() + static_cast<std::size_t>(within), 2 * of->links.size());
    for (const Link& link : of->links) {
      const auto expect_link = [&](NodeId to, NodeId from, const Slope& here, const Slope& there) {
        std::size_t found = 0;
        for (const LinkEnd& end : table.of(to)) {
          if (end.from != from) continue;
          ++found;
          EXPECT_NEAR(static_cast<double>(end.F) * of->tree[to].shape.area, static_cast<double>(link.G),
                      1e-7 * static_cast<double>(link.G));
          EXPECT_EQ(end.here.u, here.u);
          EXPECT_EQ(end.here.v, here.v);
          EXPECT_EQ(end.there.u, there.u);
          EXPECT_EQ(end.there.v, there.v);
          EXPECT_EQ(end.partial, link.partial);
        }
        EXPECT_EQ(found, 1U);
      };
      expect_link(link.p, link.q, link.over_p, link.over_q);
      expect_link(link.q, link.p, link.over_q, link.over_p);
    }
  }
}

TEST_F(LinkOperators, IsTheMatrixOfItsLinks) {
  for (const RefinedTree* of : {&made, &plates, &coarse}) {
    const Matrix matrix(*of);
    const auto dense = matrix.dense();
    const std::vector<Rgb> x = random_values(dense.size(), 3);
    std::vector<Rgb> H(x.size());
    LinkOperator F = matrix.F();
    F.apply(x, H);
    Rgb largest(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      Rgb expected(0);
      for (std::size_t j = 0; j < x.size(); ++j) expected += dense[i][j] * x[j];
      for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(H[i][c], expected[c], 1e-12) << i;
      largest = glm::max(largest, glm::abs(H[i]));
    }
    EXPECT_GT(largest.g, of == &coarse ? 0.01 : 0.1) << "compared with nothing";
  }
}

TEST_F(LinkOperators, GoesThroughNodesThatHaveLinksAlone) {
  EXPECT_LT(Matrix(coarse).linked.nodes().size(), coarse.tree.size() / 4);
}

TEST_F(LinkOperators, WhatOneSendsTheOtherReceives) {
  for (const RefinedTree* of : {&made, &plates}) {
    const Matrix matrix(*of);
    const auto dense = matrix.dense();
    const std::vector<double>& area = matrix.leaves.unknowns().area;
    double largest = 0;
    for (std::size_t i = 0; i < dense.size(); ++i) {
      for (std::size_t j = 0; j < dense.size(); ++j) {
        // Exchange areas are in single precision.
        constexpr double kOfFloats = std::numeric_limits<float>::epsilon();
        EXPECT_NEAR(area[i] * dense[i][j], area[j] * dense[j][i],
                    kOfFloats * area[i] * std::abs(dense[i][j]) + 1e-12);
        EXPECT_GE(dense[i][j], -1e-3 * dense[j][j] - 1e-6);  // no pair gets less than nothing
        largest = std::max(largest, dense[i][j]);
      }
    }
    EXPECT_GT(largest, 0.01);
  }
}

TEST_F(LinkOperators, RowsOfAClosedCubeAddUpToOne) {
  const RefinedTree cube(test_scenes::unit_cube(), 1e-4);
  const Matrix matrix(cube);
  LinkOperator F = matrix.F();
  const std::vector<double> ones(matrix.leaves.nodes().size(), 1.0);
  std::vector<double> sums(ones.size());
  F.apply(ones, sums);
  double squares = 0, mean = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double share = matrix.leaves.unknowns().area[i] / 6;
    mean += share * sums[i];
    squares += share * (sums[i] - 1) * (sums[i] - 1);
  }
  EXPECT_NEAR(mean, 1, 2e-4);
  EXPECT_LT(std::sqrt(squares), 0.03);
}

TEST_F(LinkOperators, SumsAreTheSameForEveryPartitionOfTheLinks) {
  for (const RefinedTree* of : {&made, &plates}) {
    const Matrix matrix(*of);
    const std::vector<Rgb> x = random_values(matrix.leaves.nodes().size(), 4);
    std::vector<Rgb> whole(x.size());
    LinkOperator F = matrix.F();
    F.apply(x, whole);
    std::mt19937 random(5);
    for (const std::size_t ranks : {2U, 7U}) {
      std::vector<Link> shuffled = of->links;
      std::ranges::shuffle(shuffled, random);
      std::vector<std::vector<Link>> of_rank(ranks);
      for (const Link& link : shuffled) of_rank[random() % ranks].push_back(link);
      std::vector<std::uint64_t> total;
      std::vector<Rgb> H(x.size());
      for (const std::vector<Link>& links : of_rank) {
        const LinkTable table(of->tree, links);
        const SumOverRanks add = [&](std::span<std::uint64_t> sums) {
          if (total.empty()) total.assign(sums.size(), 0);
          for (std::size_t k = 0; k < sums.size(); ++k) sums[k] = total[k] += sums[k];
        };
        LinkOperator part(matrix.linked, table, add, 1);
        part.apply(x, H);
      }
      EXPECT_EQ(std::memcmp(H.data(), whole.data(), H.size() * sizeof(Rgb)), 0) << ranks;
    }
  }
}

TEST_F(LinkOperators, ColoursAndOneChannelAgree) {
  const Matrix matrix(made);
  LinkOperator F = matrix.F();
  const std::size_t n = matrix.leaves.nodes().size();
  std::vector<Rgb> x = random_values(n, 6), H(n);
  std::vector<double> grey(n), of_grey(n);
  for (std::size_t k = 0; k < n; ++k) grey[k] = x[k].g;
  F.apply(x, H);
  F.apply(grey, of_grey);
  for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(H[k].g, of_grey[k], 1e-13);
  // Of colours that are all the same no bit differs.
  for (std::size_t k = 0; k < n; ++k) x[k] = Rgb(grey[k]);
  F.apply(x, H);
  for (std::size_t k = 0; k < n; ++k) EXPECT_EQ(H[k], Rgb(of_grey[k]));
}

TEST_F(LinkOperators, OneThreadAndTwoAgree) {
  const Matrix matrix(plates);
  const std::vector<Rgb> x = random_values(matrix.leaves.nodes().size(), 7);
  std::vector<Rgb> one(x.size()), two(x.size());
  matrix.F().apply(x, one);
  LinkOperator(matrix.linked, matrix.table, kAlone, 2).apply(x, two);
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(Rgb)), 0);
}

TEST_F(LinkOperators, TheUnitOfTheLightChangesNoDigit) {
  const Matrix matrix(made);
  std::vector<Rgb> x = random_values(matrix.leaves.nodes().size(), 8), H(x.size()), scaled(x.size());
  matrix.F().apply(x, H);
  for (Rgb& value : x) value *= 0x1p-70;
  matrix.F().apply(x, scaled);
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_EQ(scaled[k] * 0x1p70, H[k]);
  std::ranges::fill(x, Rgb(0));
  matrix.F().apply(x, H);
  for (const Rgb& of_nothing : H) EXPECT_EQ(of_nothing, Rgb(0));
}

TEST_F(LinkOperators, SlopesAreThoseOfTheLinks) {
  const Matrix matrix(made);
  const NodeTree& tree = made.tree;
  const std::vector<Rgb> x = random_values(matrix.leaves.nodes().size(), 9);
  std::vector<Rgb> H(x.size()), plain(x.size());
  std::vector<std::array<Rgb, 2>> slopes(x.size());
  matrix.F().apply_with_slopes(x, H, slopes);
  matrix.F().apply(x, plain);
  EXPECT_EQ(H, plain);
  std::vector<Rgb> means(tree.size(), Rgb(0));
  for (std::size_t k = 0; k < x.size(); ++k) means[matrix.leaves.nodes()[k]] = x[k];
  pull(tree, std::span(means));
  double largest = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const NodeId leaf = matrix.leaves.nodes()[k];
    double u = 0, v = 0;
    for (NodeId id = leaf; id != kNoNode; id = tree[id].parent) {
      const glm::dvec2 shrunk = tree.is_cluster(id) ? glm::dvec2(0) : tree.shrinking(id, leaf) / kSlopeOne;
      for (const LinkEnd& end : matrix.table.of(id)) {
        double sent = static_cast<double>(end.F) * means[end.from].g;
        for (std::size_t j = 0; j < x.size(); ++j) {
          const NodeId from = matrix.leaves.nodes()[j];
          if (!test_scenes::is_within(tree, from, end.from) || tree.is_cluster(end.from)) continue;
          const glm::dvec2 at = tree.place(end.from, tree[from].shape.centroid) / kSlopeOne;
          sent += static_cast<double>(end.F) * matrix.share(from, end.from, id) *
                  (end.there.u * at.x + end.there.v * at.y) * x[j].g;
        }
        u += shrunk.x * end.here.u * sent;
        v += shrunk.y * end.here.v * sent;
      }
    }
    EXPECT_NEAR(slopes[k][0].g, u, 1e-12);
    EXPECT_NEAR(slopes[k][1].g, v, 1e-12);
    largest = std::max(largest, std::abs(u));
  }
  EXPECT_GT(largest, 0.01);
}

TEST_F(LinkOperators, HasNoSweeps) {
  const Matrix matrix(made);
  LinkOperator F = matrix.F();
  std::vector<double> x(matrix.leaves.nodes().size());
  EXPECT_THROW(F.sweep(x, x, x), std::logic_error);
  std::vector<Rgb> colours(x.size());
  EXPECT_THROW(F.sweep(colours, colours, colours), std::logic_error);
}

}  // namespace
}  // namespace fluxel
