#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bench/stability/view_setup.hpp"
#include "tests/closed_forms/radiosity.hpp"
#include "tests/stability/world.hpp"

namespace fluxel {
namespace {

using closed_forms::CubeWalls;

lab::Run solve(int n, double rho, const char* method, double tolerance = 1e-6) {
  lab::Setup setup = lab::unit_cube(n, rho, 1, 0);
  setup.stop.tolerance = tolerance;
  lab::Run run = lab::run(test::world(), setup, lab::method_named(method));
  EXPECT_TRUE(run.radiosity.converged) << run.radiosity.cause;
  return run;
}

CubeWalls averages(const lab::Run& run) {
  return {run.mean_B("floor"), run.mean_B("ceiling"), run.mean_B("sides")};
}

double sum(const CubeWalls& walls) { return walls.emitter + walls.opposite + 4 * walls.side; }

/// Errors, the walls' relative to `exact`, the sum's to 1 / (1 - rho).
std::array<double, 4> errors(const CubeWalls& found, const CubeWalls& exact) {
  return {found.emitter / exact.emitter - 1, found.opposite / exact.opposite - 1, found.side / exact.side - 1,
          sum(found) / sum(exact) - 1};
}

double largest_of_walls(const std::array<double, 4>& errors) {
  return std::max({std::abs(errors[0]), std::abs(errors[1]), std::abs(errors[2])});
}

void print(const char* method, int n, double rho, const std::array<double, 4>& errors) {
  std::printf(
      "emitting wall, rho %.1f, %s, n = %2d: relative errors of the averages %+.2e %+.2e %+.2e, sum %+.2e\n",
      rho, method, n, errors[0], errors[1], errors[2], errors[3]);
}

TEST(EmittingWall, TheDiscRuleApproachesTheContinuousSolution) {
  const closed_forms::ContinuousCube& exact = closed_forms::kContinuousCube[0];
  std::vector<std::array<double, 4>> at;
  for (const int n : {4, 8, 16}) {
    const CubeWalls found = averages(solve(n, exact.rho, "disc"));
    EXPECT_LT(sum(found), 2) << "row sums below 1 lose light";
    at.push_back(errors(found, exact.mean));
    print("disc", n, exact.rho, at.back());
  }
  for (std::size_t value = 0; value < 4; ++value) {
    EXPECT_LT(std::abs(at[1][value]), std::abs(at[0][value])) << value;
    EXPECT_LT(std::abs(at[2][value]), std::abs(at[1][value])) << value;
    // Measured: a fall by 2.5 to 2.7, an order of 0.7, rising to 0.8 in the last step. The disc rule's defect
    // of row sums along the edges decides it; exact factors reach 1.75.
    EXPECT_GT(at[0][value] / at[2][value], 2.2) << value;
  }
}

// Constant elements with exact form factors have errors of the averages of 0.05 % at n = 8 and 0.004 % at
// n = 32; what is allowed beyond that is the form factors'.
TEST(EmittingWall, AdaptiveIsWithinTwoThousandthsAtEightAndATenthOfItAt32) {
  for (const double rho : {0.5, 0.9}) {
    const auto* exact =
        std::ranges::find(closed_forms::kContinuousCube, rho, &closed_forms::ContinuousCube::rho);
    for (const char* method : {"adaptive", "adaptive, closure"}) {
      for (const auto& [n, allowed] : {std::pair{8, 2e-3}, std::pair{32, 2e-4}}) {
        const std::array<double, 4> found = errors(averages(solve(n, rho, method)), exact->mean);
        print(method, n, rho, found);
        EXPECT_LE(largest_of_walls(found), allowed) << method << ", rho " << rho << ", n " << n;
      }
    }
  }
}

// One element a wall is another, exactly known system, which a refined solution must leave.
TEST(EmittingWall, AdaptiveSolvesTheSystemOfSixElements) {
  for (const double rho : {0.5, 0.9, 0.99}) {
    const CubeWalls six = closed_forms::cube_of_six_elements(rho);
    const auto error = [&](int n, const char* method, double tolerance) {
      return largest_of_walls(errors(averages(solve(n, rho, method, tolerance)), six));
    };
    // The dimmest wall has a sixth of the light, so what two form factors of one row lack or have too much
    // shows more there than in the row's sum; near rho = 1 the sum decides, and closure makes that 1.
    EXPECT_LE(error(1, "adaptive, closure", 8e-6), rho < 0.99 ? 5e-5 : 1e-5) << rho;
    EXPECT_LE(error(1, "adaptive", 2e-5), 5e-5 + 1e-5 / (1 - rho)) << rho;
    EXPECT_GE(error(8, "adaptive", 1e-4), 1e-3) << rho;
  }
}

TEST(EmittingWall, SymmetryIsKept) {
  for (const char* method : {"disc", "adaptive"}) {
    const lab::Run run = solve(8, 0.5, method);
    // By the direction in which the four side walls face.
    std::array<double, 4> side{};
    for (std::size_t i = 0; i < run.mesh.elements.size(); ++i) {
      const glm::vec3& normal = run.mesh.elements[i].normal;
      if (std::abs(normal.z) > 0.5f) continue;
      const std::size_t wall = std::abs(normal.x) > 0.5f ? (normal.x > 0 ? 0 : 1) : (normal.y > 0 ? 2 : 3);
      side[wall] += run.radiosity.B[i].r / 64;
    }
    for (const double average : side) EXPECT_NEAR(average, side[0], 1e-6) << method;
  }
}

}  // namespace
}  // namespace fluxel
