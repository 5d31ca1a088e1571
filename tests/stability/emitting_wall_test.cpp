#include <gtest/gtest.h>

#include <cstdio>

#include "cube.hpp"

namespace fluxel {
namespace {

// A unit cube with rho = 0.5, its floor emits 1: averages over the walls of the true continuous solution,
// from exact form factors on up to 64 x 64 x 6 elements extrapolated, and confirmed by photon tracing.
constexpr double kEmitter = 1.104362, kOpposite = 0.171216, kSide = 0.181105;

struct Averages {
  double emitter, opposite, side;

  [[nodiscard]] double sum() const { return emitter + opposite + 4 * side; }
};

Averages averages(int n) {
  Cube cube(n);
  cube.light_the_floor(0.5);
  const Radiosity result = cube.solve(PairRule::disc, Solver::jacobi, {1e-6, 1000});
  EXPECT_TRUE(result.converged) << result.cause;
  return {cube.wall_average(result, 0, 1), cube.wall_average(result, 1, 2), cube.wall_average(result, 2, 6)};
}

TEST(EmittingWall, RefinementApproachesTheContinuousSolution) {
  std::vector<Averages> at;
  for (const int n : {4, 8, 16}) {
    at.push_back(averages(n));
    std::printf("emitting wall, n = %2d: errors of the averages %+.6f %+.6f %+.6f, of their sum %+.6f\n", n,
                at.back().emitter - kEmitter, at.back().opposite - kOpposite, at.back().side - kSide,
                at.back().sum() - 2);
  }
  for (const Averages& values : at) EXPECT_LT(values.sum(), 2) << "row sums below 1 lose light";
  const auto error = [&](std::size_t k) {
    return std::array{std::abs(at[k].emitter - kEmitter), std::abs(at[k].opposite - kOpposite),
                      std::abs(at[k].side - kSide), std::abs(at[k].sum() - 2)};
  };
  for (std::size_t value = 0; value < 4; ++value) {
    EXPECT_LT(error(1)[value], error(0)[value]) << value;
    EXPECT_LT(error(2)[value], error(1)[value]) << value;
    // Measured: a fall by 2.5 to 2.7, an order of 0.7, rising to 0.8 in the last step. The disc rule's defect
    // of row sums along the edges decides it; exact factors reach 1.75.
    EXPECT_GT(error(0)[value] / error(2)[value], 2.2) << value;
  }
}

TEST(EmittingWall, SymmetryIsKept) {
  Cube cube(8);
  cube.light_the_floor(0.5);
  const Radiosity result = cube.solve(PairRule::disc, Solver::jacobi, {1e-6, 1000});
  const double side = cube.wall_average(result, 2, 3);
  for (std::size_t wall = 3; wall < 6; ++wall)
    EXPECT_NEAR(cube.wall_average(result, wall, wall + 1), side, 1e-6);
}

}  // namespace
}  // namespace fluxel
