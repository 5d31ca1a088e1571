#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/stability/view_setup.hpp"
#include "tests/stability/world.hpp"

namespace fluxel {
namespace {

lab::Run solve(const lab::Setup& setup, const char* method) {
  return lab::run(test::world(), setup, lab::method_named(method));
}

/// One reflectance, exitance 1 of the floor.
lab::Run solve_lit_floor(int n, double rho, const char* method, StopRule stop = {1e-3, 2000}) {
  lab::Setup setup = lab::unit_cube(n, rho, 1, 0);
  setup.stop = stop;
  return solve(setup, method);
}

struct Deviation {
  double rms = 0, largest = 0;
};

/// Of B from 1, area-weighted (elements are equal).
Deviation deviation(const lab::Run& run) {
  EXPECT_TRUE(run.radiosity.converged) << run.radiosity.cause;
  Deviation found;
  for (const Rgb& B : run.radiosity.B) {
    found.rms += (B.r - 1) * (B.r - 1) / static_cast<double>(run.radiosity.B.size());
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
    const lab::Run run = solve(lab::unit_furnace(n, 0.9, 1), "disc");
    ASSERT_EQ(run.mesh.elements.size(), static_cast<std::size_t>(6 * n * n));
    found.push_back(deviation(run));
    std::printf("furnace, disc, n = %d: rms of B - 1 %.5f, largest %.5f\n", n, found.back().rms,
                found.back().largest);
  }
  EXPECT_LE(found[1].rms, 0.02);
  EXPECT_LE(found[1].largest, 0.06);
  EXPECT_LT(found[1].rms, found[0].rms);
  EXPECT_GT(found[1].largest, 0.02) << "the maximum does not converge with the rule as it is";
}

TEST(Furnace, AdaptiveIsWithinAThousandthAndWithClosureWithinAMillionth) {
  for (const int n : {4, 8, 16}) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      lab::Setup setup = lab::unit_furnace(n, 0.9, seed);
      setup.stop.tolerance = 5e-7;
      const double plain = deviation(solve(setup, "adaptive")).largest;
      const lab::Run closed = solve(setup, "adaptive, closure");
      const double with_closure = deviation(closed).largest;
      std::printf("furnace, adaptive, n = %2d: largest |B - 1| %.2g, with closure %.2g\n", n, plain,
                  with_closure);
      EXPECT_LE(plain, 1e-3) << n;
      EXPECT_LE(with_closure, 1e-6) << n;
      ASSERT_TRUE(closed.form_factors.closure);
      EXPECT_TRUE(closed.form_factors.closure->trusted);
      EXPECT_LE(closed.form_factors.closure->largest_change, 1e-2);
    }
  }
}

TEST(Furnace, AdaptiveConvergesAtTheHighestReflectances) {
  for (const double rho_max : {0.99, 0.9999}) {
    for (const char* method : {"adaptive", "adaptive, closure", "adaptive, Gauss-Seidel"}) {
      const double random = deviation(solve(lab::unit_furnace(8, rho_max, 1), method)).largest;
      std::printf("furnace, %s, rho random up to %g: largest |B - 1| %.2g\n", method, rho_max, random);
      EXPECT_LE(random, 1e-3);
    }
  }
}

// The light of a closed room is emitted / (1 - rho): nothing of it may get lost or appear. A row sum's error
// is amplified by 1 / (1 - rho), and only closure can hold that.
// B is 1 / (1 - rho) times the light: single precision, 1e-7 of B at every reflection, leaves 1e-3 of B at
// 0.9999, and its bound, which adds up the worst everywhere, a tenth. The same factor stands before the
// defect of the row sums.
TEST(Furnace, ALitRoomConvergesAtTheHighestReflectances) {
  for (const auto& [rho, tolerance] : {std::pair(0.99, 1e-2), std::pair(0.9999, 1e-1)}) {
    for (const char* method : {"adaptive", "adaptive, closure"}) {
      const lab::Run run = solve_lit_floor(4, rho, method, {tolerance, 1000000});
      EXPECT_TRUE(run.radiosity.converged) << method << ' ' << rho << ": " << run.radiosity.cause;
      const double error = 6 * area_mean(run.unknowns, run.radiosity.B).r * (1 - rho) - 1;
      std::printf("lit room, %s, rho = %g: error of the mean of B %+.2g after %d iterations\n", method, rho,
                  error, run.radiosity.iterations);
      if (run.form_factors.closure) {
        EXPECT_LE(std::abs(error), tolerance) << rho;
      }
    }
  }
}

TEST(Furnace, RowSumsAreAsKnown) {
  struct Known {
    int n;
    const char* method;
    double least, mean, largest, digit;
  };
  // Row sums of centre-to-centre factors on an n x n x 6 cube, as computed independently in double precision;
  // a room's are 1.
  for (const Known& known :
       {Known{4, "point", 1.035, 1.136, 1.243, 6e-4}, Known{8, "point", 1.007, 1.068, 1.239, 6e-4},
        Known{16, "point", 1.002, 1.034, 1.238, 6e-4}, Known{4, "disc", 0.962, 0.972, 0.992, 6e-4},
        Known{8, "disc", 0.962, 0.982, 0.998, 6e-4}, Known{16, "disc", 0.963, 0.990, 0.9995, 6e-4},
        Known{4, "adaptive", 1, 1, 1, 1e-3}, Known{8, "adaptive", 1, 1, 1, 1e-3},
        Known{16, "adaptive", 1, 1, 1, 1e-3}}) {
    const std::vector<double> sums = solve_lit_floor(known.n, 0.5, known.method).row_sums;
    double mean = 0;
    for (const double sum : sums) mean += sum / static_cast<double>(sums.size());
    EXPECT_NEAR(std::ranges::min(sums), known.least, known.digit) << known.method << ' ' << known.n;
    EXPECT_NEAR(mean, known.mean, known.digit) << known.method << ' ' << known.n;
    EXPECT_NEAR(std::ranges::max(sums), known.largest, known.digit) << known.method << ' ' << known.n;
  }
}

TEST(Furnace, ThePointRuleDivergesOnCoarseCornersAndSaysSo) {
  for (const int n : {4, 8}) {
    lab::Method method = lab::method_named("point");
    for (const Solver solver : {Solver::jacobi, Solver::gauss_seidel}) {
      method.solver = solver;
      lab::Setup setup = lab::unit_cube(n, 0.95, 1, 0);
      setup.stop = {1e-3, 1000};
      setup.stop.against_growth = "use another rule";
      const lab::Run run = lab::run(test::world(), setup, method);
      EXPECT_GT(run.form_factors.row_sum_max, 1.2);
      EXPECT_FALSE(run.radiosity.converged);
      EXPECT_TRUE(std::isinf(run.radiosity.error_bound));
      EXPECT_TRUE(run.radiosity.cause.ends_with("use another rule")) << run.radiosity.cause;
    }
  }
}

TEST(Furnace, TheDiscRuleConvergesAtEveryReflectance) {
  lab::Method method = lab::method_named("disc");
  for (const int n : {1, 2, 4, 8}) {
    for (const double rho : {0.9, 0.95, 0.97}) {
      lab::Setup setup = lab::unit_cube(n, rho, 1, 0);
      setup.stop = {1e-3, 2000};
      for (const Solver solver : {Solver::jacobi, Solver::gauss_seidel}) {
        method.solver = solver;
        EXPECT_TRUE(lab::run(test::world(), setup, method).radiosity.converged) << n << ' ' << rho;
      }
    }
  }
  for (const int n : {2, 4, 8, 16}) {
    const lab::Run run = solve_lit_floor(n, 0.99, "disc");
    EXPECT_TRUE(run.radiosity.converged) << run.radiosity.cause;
    // Row sums below 1 take light away: never more than the closed cube's mean of 1/6 / (1 - rho).
    EXPECT_LT(area_mean(run.unknowns, run.radiosity.B).r, 1.001 / 6 / 0.01);
  }
}

// A single element a wall has disc row sums of 1.0194: at rho = 0.99 that amplifies, and the result says so.
TEST(Furnace, OneElementAWallAmplifiesAtTheHighestReflectance) {
  const lab::Run run = solve_lit_floor(1, 0.99, "disc");
  EXPECT_NEAR(std::ranges::max(run.row_sums), 1.01942, 1e-5);
  EXPECT_FALSE(run.radiosity.converged);
  EXPECT_FALSE(run.radiosity.cause.empty());
}

TEST(Furnace, GaussSeidelAndJacobiAgree) {
  for (const char* name : {"disc", "adaptive"}) {
    lab::Setup setup = lab::unit_furnace(8, 0.9, 3);
    setup.stop.tolerance = 1e-5;
    lab::Method method = lab::method_named(name);
    const Radiosity jacobi = lab::run(test::world(), setup, method).radiosity;
    method.solver = Solver::gauss_seidel;
    const Radiosity gauss_seidel = lab::run(test::world(), setup, method).radiosity;
    EXPECT_LT(gauss_seidel.iterations, jacobi.iterations);
    ASSERT_EQ(jacobi.B.size(), gauss_seidel.B.size());
    for (std::size_t i = 0; i < jacobi.B.size(); ++i)
      EXPECT_NEAR(jacobi.B[i].r, gauss_seidel.B[i].r, 2e-5) << name;
  }
}

}  // namespace
}  // namespace fluxel
