#include "solver/closure.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/scaled_operator.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::DenseOperator;
using test_scenes::uniform;
using Matrix = std::vector<std::vector<double>>;

/// F of a random symmetric G and random areas, and the areas.
struct SymmetricFactors {
  Matrix F;
  std::vector<double> area;
};

/// Row sums differ from `sum` by up to `defect`, relative.
SymmetricFactors random_factors(std::size_t n, double sum, double defect, std::mt19937& random) {
  SymmetricFactors made{Matrix(n, std::vector<double>(n)), std::vector<double>(n)};
  Matrix G = made.F;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) G[i][j] = G[j][i] = uniform(random, 0.1, 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double wanted = sum * uniform(random, 1 - defect, 1 + defect);
    made.area[i] = std::accumulate(G[i].begin(), G[i].end(), 0.0) / wanted;
    for (std::size_t j = 0; j < n; ++j) made.F[i][j] = G[i][j] / made.area[i];
  }
  return made;
}

Matrix scaled(Matrix F, const std::vector<double>& scale) {
  for (std::size_t i = 0; i < F.size(); ++i)
    for (std::size_t j = 0; j < F.size(); ++j) F[i][j] *= scale[i] * scale[j];
  return F;
}

double row_sum(const Matrix& F, std::size_t i) { return std::accumulate(F[i].begin(), F[i].end(), 0.0); }

TEST(RowSums, OfAMatrix) {
  DenseOperator F({{0, 0.25, 0.5}, {0.125, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(row_sums_of(F, 3), (std::vector{0.75, 0.125, 0.0}));
}

TEST(Closure, ReachesTheRowSumsAndKeepsReciprocity) {
  std::mt19937 random(1);
  for (const double wanted_sum : {1.0, 0.6}) {
    const SymmetricFactors factors = random_factors(40, wanted_sum, 0.03, random);
    DenseOperator F(factors.F);
    const Closure closure = find_closure(F, std::vector<double>(40, wanted_sum));
    const Matrix closed = scaled(factors.F, closure.scale);
    double largest_change = 0;
    for (std::size_t i = 0; i < 40; ++i) {
      EXPECT_NEAR(row_sum(closed, i), wanted_sum, ClosureGoal{}.tolerance);
      for (std::size_t j = 0; j < 40; ++j) {
        EXPECT_NEAR(factors.area[i] * closed[i][j], factors.area[j] * closed[j][i], 1e-14);
        if (i != j) largest_change = std::max(largest_change, std::abs(closed[i][j] / factors.F[i][j] - 1));
      }
    }
    EXPECT_GT(closure.defect_before, 0.01 * wanted_sum);
    EXPECT_LE(closure.defect_after, ClosureGoal{}.tolerance);
    EXPECT_GE(closure.largest_change, largest_change);
    EXPECT_LT(closure.largest_change, 1.5 * largest_change);
    EXPECT_TRUE(closure.trusted);
    EXPECT_LT(closure.sweeps, 30);
  }
}

TEST(Closure, DifferentSumsForDifferentRows) {
  std::mt19937 random(2);
  const SymmetricFactors factors = random_factors(30, 0.7, 0.02, random);
  std::vector<double> wanted(30);
  for (double& sum : wanted) sum = uniform(random, 0.68, 0.72);
  DenseOperator F(factors.F);
  const Closure closure = find_closure(F, wanted);
  const Matrix closed = scaled(factors.F, closure.scale);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_NEAR(row_sum(closed, i), wanted[i], ClosureGoal{}.tolerance);
  EXPECT_TRUE(closure.trusted);
}

TEST(Closure, NothingToDo) {
  DenseOperator F({{0, 1}, {1, 0}});
  const Closure closure = find_closure(F, std::vector{1.0, 1.0});
  EXPECT_EQ(closure.scale, (std::vector{1.0, 1.0}));
  EXPECT_EQ(closure.sweeps, 1);
  EXPECT_EQ(closure.largest_change, 0);
  EXPECT_EQ(closure.defect_before, 0);
  EXPECT_TRUE(closure.trusted);
}

TEST(Closure, EmptyRowsAreSkipped) {
  // The fourth has no partner, the fifth is asked for nothing.
  const Matrix matrix{{0, 0.48, 0.48, 0, 0},
                      {0.48, 0, 0.48, 0, 0.001},
                      {0.48, 0.48, 0, 0, 0},
                      {0, 0, 0, 0, 0},
                      {0, 0.001, 0, 0, 0}};
  DenseOperator F(matrix);
  const Closure closure = find_closure(F, std::vector{1.0, 1.0, 1.0, 1.0, 0.0});
  EXPECT_EQ(closure.scale[3], 1);
  EXPECT_EQ(closure.scale[4], 1);
  const Matrix closed = scaled(matrix, closure.scale);
  EXPECT_NEAR(row_sum(closed, 0), 1, ClosureGoal{}.tolerance);
  EXPECT_NEAR(row_sum(closed, 1), 1, ClosureGoal{}.tolerance);
  EXPECT_TRUE(closure.trusted);
  EXPECT_NEAR(closure.defect_before, 0.04, 1e-15) << "rows that are skipped are no defect";
}

// Two open plates face each other: the sums of each are asked of the other's scale. Undamped scaling would
// swing between both for ever.
TEST(Closure, BipartitePlatesConverge) {
  std::mt19937 random(3);
  const std::size_t n = 12;
  Matrix matrix(2 * n, std::vector<double>(2 * n));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      matrix[i][n + j] = matrix[n + j][i] = uniform(random, 0.9, 1.1) * 0.2 / static_cast<double>(n);
  DenseOperator F(matrix);
  const Closure closure = find_closure(F, std::vector<double>(2 * n, 0.2));
  const Matrix closed = scaled(matrix, closure.scale);
  for (std::size_t i = 0; i < 2 * n; ++i) EXPECT_NEAR(row_sum(closed, i), 0.2, ClosureGoal{}.tolerance);
  EXPECT_TRUE(closure.trusted);
}

// Both plates together cannot be brought to sums whose totals by area differ.
TEST(Closure, WhatCannotBeReachedIsNotTrusted) {
  DenseOperator F({{0, 0.2}, {0.2, 0}});
  const Closure closure = find_closure(F, std::vector{0.2, 0.204});
  EXPECT_FALSE(closure.trusted);
  EXPECT_EQ(closure.sweeps, ClosureGoal{}.max_sweeps);
  EXPECT_GT(closure.defect_after, ClosureGoal{}.tolerance);
  for (const double scale : closure.scale) EXPECT_TRUE(std::isfinite(scale) && scale > 0);
}

TEST(Closure, TenPercentIsTooMuch) {
  for (const double sum : {0.92, 1.0 / 1.09, 1.08}) {
    DenseOperator F({{0, sum}, {sum, 0}});
    const Closure closure = find_closure(F, std::vector{1.0, 1.0});
    EXPECT_TRUE(closure.trusted) << sum;
    EXPECT_NEAR(closure.largest_change, std::abs(1 / sum - 1), 1e-6);
  }
  for (const double sum : {0.9, 1.0 / 1.11, 1.12}) {
    DenseOperator F({{0, sum}, {sum, 0}});
    const Closure closure = find_closure(F, std::vector{1.0, 1.0});
    EXPECT_FALSE(closure.trusted) << sum;
    EXPECT_LE(closure.defect_after, ClosureGoal{}.tolerance);
  }
}

/// The largest eigenvalue of a matrix without negative entries that is similar to a symmetric one, from
/// below, by power iteration: of the matrix plus 1, so that no eigenvalue of the other sign is as large.
double spectral_radius(const Matrix& F) {
  std::vector<double> x(F.size(), 1.0), y(F.size());
  double radius = 0;
  for (int k = 0; k < 500; ++k) {
    for (std::size_t i = 0; i < F.size(); ++i)
      y[i] = x[i] + std::inner_product(F[i].begin(), F[i].end(), x.begin(), 0.0);
    const double largest = *std::ranges::max_element(y);
    for (std::size_t i = 0; i < F.size(); ++i) x[i] = y[i] / largest;
    radius = largest - 1;
  }
  return radius;
}

TEST(CapRowSums, NoLightGrowsAfterwards) {
  std::mt19937 random(4);
  double largest_radius = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    const SymmetricFactors factors = random_factors(30, 1.05, 0.5, random);
    DenseOperator F(factors.F);
    const std::vector<double> sums = row_sums_of(F, 30);
    ASSERT_GT(*std::ranges::max_element(sums), 1.2);
    const std::vector<double> scale = cap_row_sums(sums);
    const double radius = spectral_radius(scaled(factors.F, scale));
    EXPECT_LE(radius, 1 + 1e-12);
    largest_radius = std::max(largest_radius, spectral_radius(factors.F));
    EXPECT_GT(radius, 0.8) << "no more is taken than has to be";
    // D D F, to which D F D is similar.
    for (std::size_t i = 0; i < 30; ++i) EXPECT_LE(scale[i] * scale[i] * row_sum(factors.F, i), 1 + 1e-15);
  }
  EXPECT_GT(largest_radius, 1.01) << "there is something to cap";
}

TEST(CapRowSums, KeepsReciprocity) {
  std::mt19937 random(5);
  const SymmetricFactors factors = random_factors(20, 1.1, 0.3, random);
  DenseOperator F(factors.F);
  const Matrix capped = scaled(factors.F, cap_row_sums(row_sums_of(F, 20)));
  for (std::size_t i = 0; i < 20; ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_NEAR(factors.area[i] * capped[i][j], factors.area[j] * capped[j][i],
                  1e-14 * factors.area[i] * capped[i][j]);
}

TEST(CapRowSums, ChangesNothingBelowOne) {
  EXPECT_EQ(cap_row_sums(std::vector{0.0, 0.5, 1.0}), (std::vector{1.0, 1.0, 1.0}));
  EXPECT_EQ(cap_row_sums(std::vector{0.0, 4.0, 1.0}), (std::vector{1.0, 0.5, 1.0}));
  EXPECT_EQ(cap_row_sums(std::vector{1.5, 8.0, 2.0}, 2), (std::vector{1.0, 0.5, 1.0}));
}

TEST(WantedRowSums, OneWhereNothingIsLost) {
  const std::vector<SideView> closed(3);
  EXPECT_EQ(wanted_row_sums({}, std::vector{0.9, 1.1, 1.0}, closed), (std::vector{1.0, 1.0, 1.0}));
  EXPECT_EQ(wanted_row_sums({}, std::vector{0.9, 0.0, 1.0}, closed), (std::vector{1.0, 0.0, 1.0})) << "empty";
}

TEST(WantedRowSums, WithinTheRaysDoubtARowStaysWhatItIs) {
  // A quarter of 64 rays is lost, to both: the uncertainty is 4 sqrt(p (1 - p) / 64) with p = 17/66.
  const std::vector<SideView> views{{0.25f, 0}, {0, 0.25f}, {0.125f, 0.125f}, {0.25f, 0}, {0.25f, 0}};
  const double uncertainty = 4 * std::sqrt(17.0 / 66 * 49 / 66 / 64);
  const std::vector<double> sums{0.75, 0.6, 0.95, 0.2, 1.3};
  const std::vector<double> wanted = wanted_row_sums({}, sums, views);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(wanted[i], sums[i]);
  EXPECT_NEAR(wanted[3], 0.75 - uncertainty, 1e-12);
  EXPECT_NEAR(wanted[4], 0.75 + uncertainty, 1e-12);
}

TEST(WantedRowSums, OneLostRayLeavesDoubtInEveryRow) {
  const std::vector<SideView> views{{0, 0}, {1.0f / 64, 0}, {1, 0}};
  const std::vector<double> wanted = wanted_row_sums({}, std::vector{0.99, 0.98, 0.01}, views);
  EXPECT_EQ(wanted[0], 0.99) << "of 64 rays one in a hundred may have been missed";
  EXPECT_EQ(wanted[1], 0.98);
  EXPECT_EQ(wanted[2], 0.01) << "what the rays did not find may be there";
  const double uncertainty = 4 * std::sqrt(65.0 / 66 * 1 / 66 / 64);
  for (const double sum : {1e-6, 0.5, 2.0})
    EXPECT_NEAR(wanted_row_sums({}, std::vector{1.0, 1.0, sum}, views)[2], std::min(sum, uncertainty), 1e-12);
}

}  // namespace
}  // namespace fluxel
