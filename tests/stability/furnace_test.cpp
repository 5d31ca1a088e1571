#include <gtest/gtest.h>

#include <cstdio>

#include "cube.hpp"

namespace fluxel {
namespace {

struct Deviation {
  double rms = 0, largest = 0;
};

/// Of B from 1, area-weighted (elements are equal).
Deviation deviation(const Radiosity& result) {
  Deviation found;
  for (const Rgb& B : result.B) {
    found.rms += (B.r - 1) * (B.r - 1) / static_cast<double>(result.B.size());
    found.largest = std::max(found.largest, std::abs(B.r - 1));
  }
  found.rms = std::sqrt(found.rms);
  return found;
}

// Along the edges of the cube the disc rule keeps its error at any refinement, because a pair of elements
// that share an edge looks the same at every size: the rms falls with the edges' share of the area, the
// maximum stays.
TEST(Furnace, TheDiscRuleIsRightOnTheWholeButNotAlongTheEdges) {
  std::vector<Deviation> found;
  for (const int n : {8, 16}) {
    Cube cube(n);
    ASSERT_EQ(cube.elements.size(), static_cast<std::size_t>(6 * n * n));
    cube.make_furnace(0.9, 1);
    const Radiosity result = cube.solve(PairRule::disc, Solver::jacobi, {1e-5, 1000});
    ASSERT_TRUE(result.converged) << result.cause;
    found.push_back(deviation(result));
    std::printf("furnace, n = %d: rms of B - 1 %.5f, largest %.5f\n", n, found.back().rms,
                found.back().largest);
  }
  EXPECT_LE(found[1].rms, 0.02);
  EXPECT_LE(found[1].largest, 0.06);
  EXPECT_LT(found[1].rms, found[0].rms);
  EXPECT_GT(found[1].largest, 0.02) << "the maximum does not converge with the rule as it is";
}

TEST(Furnace, RowSumsAreAsKnown) {
  struct Known {
    int n;
    PairRule rule;
    double least, mean, largest, digit;
  };
  // Row sums of centre-to-centre factors on an n x n x 6 cube, as computed independently in double precision.
  for (const Known& known : {Known{4, PairRule::point, 1.035, 1.136, 1.243, 6e-4},
                             Known{8, PairRule::point, 1.007, 1.068, 1.239, 6e-4},
                             Known{16, PairRule::point, 1.002, 1.034, 1.238, 6e-4},
                             Known{4, PairRule::disc, 0.962, 0.972, 0.992, 6e-4},
                             Known{8, PairRule::disc, 0.962, 0.982, 0.998, 6e-4},
                             Known{16, PairRule::disc, 0.963, 0.990, 0.9995, 6e-4}}) {
    const RowSums found = Cube(known.n).row_sums(known.rule);
    double mean = 0;
    for (const double sum : found.sums) mean += sum / static_cast<double>(found.sums.size());
    EXPECT_NEAR(std::ranges::min(found.sums), known.least, known.digit) << known.n;
    EXPECT_NEAR(mean, known.mean, known.digit) << known.n;
    EXPECT_NEAR(found.largest, known.largest, known.digit) << known.n;
  }
}

TEST(Furnace, ThePointRuleDivergesOnCoarseCornersAndSaysSo) {
  for (const int n : {4, 8}) {
    Cube cube(n);
    cube.light_the_floor(0.95);
    const RowSums row_sums = cube.row_sums(PairRule::point);
    EXPECT_GT(row_sums.largest, 1.2);
    EXPECT_FALSE(row_sums.amplifying.empty());
    EXPECT_FALSE(row_sums.weights);
    for (std::size_t i = 0; i < row_sums.sums.size(); ++i) {
      const bool named = std::ranges::count(row_sums.amplifying, i) == 1;
      EXPECT_EQ(named, 0.95 * row_sums.sums[i] >= 1) << i;
    }
    for (const Solver solver : {Solver::jacobi, Solver::gauss_seidel}) {
      const Radiosity result = cube.solve(PairRule::point, solver, {1e-3, 1000});
      EXPECT_FALSE(result.converged);
      EXPECT_TRUE(std::isinf(result.error_bound));
      EXPECT_NE(result.cause.find("--form-factor disc"), std::string::npos) << result.cause;
    }
  }
}

TEST(Furnace, TheDiscRuleConvergesAtEveryReflectance) {
  for (const int n : {1, 2, 4, 8}) {
    for (const double rho : {0.9, 0.95, 0.97}) {
      Cube cube(n);
      cube.light_the_floor(rho);
      for (const Solver solver : {Solver::jacobi, Solver::gauss_seidel})
        EXPECT_TRUE(cube.solve(PairRule::disc, solver, {1e-3, 2000}).converged) << n << ' ' << rho;
    }
  }
  for (const int n : {2, 4, 8, 16}) {
    Cube cube(n);
    cube.light_the_floor(0.99);
    const Radiosity result = cube.solve(PairRule::disc, Solver::jacobi, {1e-3, 2000});
    EXPECT_TRUE(result.converged) << result.cause;
    // Row sums below 1 take light away: never more than the closed cube's mean of 1/6 / (1 - rho).
    EXPECT_LT(cube.wall_average(result, 0, 6), 1.001 / 6 / 0.01);
  }
}

// A single element a wall has disc row sums of 1.0194: at rho = 0.99 that amplifies, and the result says so.
TEST(Furnace, OneElementAWallAmplifiesAtTheHighestReflectance) {
  Cube cube(1);
  cube.light_the_floor(0.99);
  EXPECT_NEAR(cube.row_sums(PairRule::disc).largest, 1.01942, 1e-5);
  const Radiosity result = cube.solve(PairRule::disc, Solver::jacobi, {1e-3, 2000});
  EXPECT_FALSE(result.converged);
  EXPECT_FALSE(result.cause.empty());
}

TEST(Furnace, GaussSeidelAndJacobiAgree) {
  Cube cube(8);
  cube.make_furnace(0.9, 3);
  const Radiosity jacobi = cube.solve(PairRule::disc, Solver::jacobi, {1e-5, 1000});
  const Radiosity gauss_seidel = cube.solve(PairRule::disc, Solver::gauss_seidel, {1e-5, 1000});
  EXPECT_LT(gauss_seidel.iterations, jacobi.iterations);
  EXPECT_LT(test_scenes::largest_difference(jacobi.B, gauss_seidel.B).r, 2e-5);
}

}  // namespace
}  // namespace fluxel
