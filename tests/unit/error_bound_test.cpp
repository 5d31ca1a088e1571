#include "solver/error_bound.hpp"

#include <gtest/gtest.h>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::DenseOperator;
using test_scenes::largest_difference;
using test_scenes::random_matrix;
using test_scenes::random_unknowns;

/// Iterates and compares the bound with the true error at every step, until the error is 1e-9. Returns how
/// many times too large the bound was at most.
double expect_bound_holds(Solver solver, DenseOperator& F, const Unknowns& unknowns, const RowSums& found) {
  const auto system = make_system<Rgb>(F, unknowns);
  const std::vector<Rgb> exact = F.exact_solution(unknowns);
  std::vector<Rgb> before = unknowns.E, after(before.size()), H(before.size());
  double slack = 0;
  for (int iteration = 0; iteration < 500; ++iteration) {
    if (solver == Solver::jacobi) {
      F.apply(before, H);
      for (std::size_t i = 0; i < H.size(); ++i) after[i] = unknowns.E[i] + unknowns.rho[i] * H[i];
    } else {
      after = before;
      F.sweep(unknowns.E, unknowns.rho, after);
    }
    std::vector<Rgb> step(after.size());
    for (std::size_t i = 0; i < step.size(); ++i) step[i] = after[i] - before[i];
    const Rgb bound = error_bound<Rgb>(found, system, step, ChangeKind::step).largest;
    const Rgb error = largest_difference(after, exact);
    for (int channel = 0; channel < kChannels; ++channel) {
      // The exact solution has errors of its own, of some 1e-15.
      EXPECT_GE(bound[channel], error[channel] - 1e-13) << "iteration " << iteration;
      if (error[channel] > 1e-9) slack = std::max(slack, bound[channel] / error[channel]);
    }
    before.swap(after);
    if (std::max({error.r, error.g, error.b}) < 1e-9) return slack;
  }
  ADD_FAILURE() << "did not converge";
  return slack;
}

TEST(ErrorBound, HoldsAtEveryIterationAndIsNoWildGuess) {
  std::mt19937 random(1);
  for (const double rho_max : {0.3, 0.7, 0.95}) {
    for (const Solver solver : {Solver::jacobi, Solver::gauss_seidel}) {
      DenseOperator F(random_matrix(40, 0.98, random));
      Unknowns unknowns = random_unknowns(40, rho_max, random);
      for (Rgb& rho : unknowns.rho) rho = Rgb(rho_max);
      const RowSums found = find_error_weights(F, unknowns);
      ASSERT_TRUE(found.weights);
      // With d = e - e' and e' = mu e after some steps, the bound rho / (1 - rho) |d| is too large by
      // rho (1 - mu) / (mu (1 - rho)): 1 for Jacobi's mu = rho, (1 + rho) / rho for a mu of rho^2, which no
      // sweep of Gauss-Seidel's method beats by far.
      const double expected = solver == Solver::jacobi ? 1 : (1 + rho_max) / rho_max;
      const double slack = expect_bound_holds(solver, F, unknowns, found);
      EXPECT_LT(slack, 1.5 * expected) << rho_max;
    }
  }
}

TEST(ErrorBound, HoldsForRandomReflectances) {
  std::mt19937 random(2);
  for (int repeat = 0; repeat < 10; ++repeat) {
    for (const Solver solver : {Solver::jacobi, Solver::gauss_seidel}) {
      DenseOperator F(random_matrix(30, 1, random));
      const Unknowns unknowns = random_unknowns(30, 0.9, random);
      const RowSums found = find_error_weights(F, unknowns);
      ASSERT_TRUE(found.weights);
      expect_bound_holds(solver, F, unknowns, found);
    }
  }
}

TEST(ErrorBound, IsSharpForOneUniformMode) {
  // F = 1 everywhere but on the diagonal, over n - 1: from B = E + e the error is uniform and shrinks by rho.
  const std::size_t n = 5;
  std::vector<std::vector<double>> matrix(n, std::vector<double>(n, 0.25));
  for (std::size_t i = 0; i < n; ++i) matrix[i][i] = 0;
  DenseOperator F(matrix);
  Unknowns unknowns;
  unknowns.elements = unknowns.active = n;
  unknowns.E.assign(n, Rgb(1));
  unknowns.rho.assign(n, Rgb(0.8));
  unknowns.area.assign(n, 1);
  const RowSums found = find_error_weights(F, unknowns);
  ASSERT_TRUE(found.weights);
  // From B = 1 to 1.8; B* = 5, so the error is 3.2.
  const std::vector<Rgb> step(n, Rgb(0.8));
  const Rgb bound = error_bound<Rgb>(found, make_system<Rgb>(F, unknowns), step, ChangeKind::step).largest;
  for (int channel = 0; channel < kChannels; ++channel) EXPECT_NEAR(bound[channel], 3.2, 1e-12);
}

TEST(ErrorBound, OnesServeWhereRowSumsStayBelowOne) {
  std::mt19937 random(3);
  DenseOperator F(random_matrix(20, 0.9, random));
  const Unknowns unknowns = random_unknowns(20, 0.9, random);
  const RowSums found = find_error_weights(F, unknowns);
  EXPECT_EQ(found.sweeps, 1);
  EXPECT_NEAR(found.largest, 0.9, 1e-12);
  EXPECT_TRUE(found.amplifying.empty());
  ASSERT_TRUE(found.weights);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(found.sums[i], 0.9, 1e-12);
    EXPECT_EQ(found.weights->w[i], 1);
    const Rgb& rho = unknowns.rho[i];
    EXPECT_NEAR(found.weights->v[i], 1 - 0.9 * std::max({rho.r, rho.g, rho.b}), 1e-12);
  }
}

/// Rows of sum 0.6, and one that amplifies although the whole does not.
DenseOperator with_a_heavy_row(std::size_t row, double row_sum, std::mt19937& random) {
  std::vector<std::vector<double>> matrix = random_matrix(25, 0.6, random);
  for (double& entry : matrix[row]) entry *= row_sum / 0.6;
  return DenseOperator(matrix);
}

TEST(ErrorBound, WeightsAreFoundWhereOnlyARowAmplifies) {
  std::mt19937 random(4);
  DenseOperator F = with_a_heavy_row(7, 1.6, random);
  Unknowns unknowns = random_unknowns(25, 0.9, random);
  for (Rgb& rho : unknowns.rho) rho = Rgb(0.9, 0.5, 0.1);
  const RowSums found = find_error_weights(F, unknowns);
  EXPECT_EQ(found.amplifying, std::vector<std::size_t>{7});
  EXPECT_NEAR(found.largest, 1.6, 1e-12);
  EXPECT_GT(found.sweeps, 1);
  ASSERT_TRUE(found.weights);
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_GT(found.weights->w[i], 0);
    EXPECT_GT(found.weights->v[i], 0);
  }
  for (const Solver solver : {Solver::jacobi, Solver::gauss_seidel})
    expect_bound_holds(solver, F, unknowns, found);
}

TEST(ErrorBound, NoWeightsWhereTheWholeAmplifies) {
  std::mt19937 random(5);
  DenseOperator F(random_matrix(25, 1.2, random));
  Unknowns unknowns = random_unknowns(25, 0.9, random);
  for (Rgb& rho : unknowns.rho) rho = Rgb(0.5, 0.9, 0.5);
  const RowSums found = find_error_weights(F, unknowns);
  EXPECT_FALSE(found.weights);
  EXPECT_EQ(found.amplifying.size(), 25u);
  EXPECT_NEAR(found.largest, 1.2, 1e-12);
}

}  // namespace
}  // namespace fluxel
