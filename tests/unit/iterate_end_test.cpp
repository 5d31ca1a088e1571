// When solvers end, and what they then say.
#include <gtest/gtest.h>

#include "solver/iterate.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::kSolvers;
using test_scenes::random_system;
using test_scenes::RandomSystem;

constexpr double kRounding = 1e-6;

Radiosity solve(Solver solver, RandomSystem& system, const StopRule& stop, double rounding = 0,
                std::span<const Rgb> start = {}) {
  const RowSums sums = find_error_weights(system.F, system.unknowns, rounding);
  return solve_radiosity(
      solver, {system.F, system.unknowns, sums}, stop, [](const IterationState&) {}, start);
}

/// Elements of a square, so that there is a discretisation error, with a random matrix.
struct SplitSquare {
  std::vector<Element> elements;
  RandomSystem system;
  DiscretisationError discretisation;

  SplitSquare(double rho, std::mt19937& random)
      : elements(test_scenes::uniform_elements(test_scenes::unit_square(Sides::one), 0.25).elements),
        system(random_system(elements.size(), 1, rho, random)),
        discretisation(elements, system.unknowns) {
    for (Rgb& of : system.unknowns.rho) of = Rgb(rho);
  }

  [[nodiscard]] StopRule stop(int max_iterations) const { return {1e-3, max_iterations, &discretisation}; }
};

TEST(IterateEnd, NothingIsClaimedWithoutABound) {
  std::mt19937 random(1);
  SplitSquare square(0.9, random);
  // More heat is drawn than sent: the mean of B is below 0, and no error is relative to it.
  for (std::size_t i = 0; i < square.elements.size(); ++i)
    square.system.unknowns.E[i] = Rgb(i == 0 ? 0.1 : -1.0, i == 0 ? 1.0 : 0.0, 0);
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, square.system, square.stop(50));
    EXPECT_FALSE(result.converged);
    EXPECT_TRUE(std::isinf(result.error_bound));
  }
}

TEST(IterateEnd, AShareThatRoundingForbidsGivesWayToTheTolerance) {
  std::mt19937 random(2);
  SplitSquare square(0.997, random);
  // Even light, even reflectance: the discretisation error is next to nothing.
  for (Rgb& E : square.system.unknowns.E) E = Rgb(1);
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, square.system, square.stop(5000), kRounding);
    EXPECT_TRUE(result.converged) << result.cause;
    EXPECT_GT(result.error_bound, kFinestTolerance);
    EXPECT_LE(result.error_bound, 1e-3);
    const Radiosity by_number = solve(solver, square.system, {1e-4, 5000}, kRounding);
    EXPECT_FALSE(by_number.converged) << "what was asked for is kept to";
    EXPECT_NE(by_number.cause.find("rounding"), std::string::npos) << by_number.cause;
  }
}

TEST(IterateEnd, AStartThatIsLitInADarkColour) {
  std::mt19937 random(3);
  RandomSystem system = random_system(40, 1, 0.9, random);
  for (Rgb& E : system.unknowns.E) E.g = 0;
  const std::vector<Rgb> start(40, Rgb(3));
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, system, {1e-6, 1000}, 0, start);
    EXPECT_TRUE(result.converged) << result.cause;
    for (const Rgb& B : result.B) EXPECT_EQ(B.g, 0);
  }
}

// The bound shows that the system contracts, so a residual that grows for a while is no divergence.
TEST(IterateEnd, TooFewIterationsAreNotCalledDivergence) {
  std::mt19937 random(4);
  for (int repeat = 0; repeat < 20; ++repeat) {
    RandomSystem system = random_system(60, 1, 0.9, random);
    for (Rgb& rho : system.unknowns.rho) rho = Rgb(0.9999);
    for (const int iterations : {1, 2, 3, 4, 5}) {
      const Radiosity result = solve(Solver::conjugate_gradients, system, {1e-9, iterations});
      EXPECT_FALSE(result.converged);
      EXPECT_NE(result.cause.find("--max-iterations"), std::string::npos) << result.cause;
    }
  }
}

TEST(IterateEnd, ConvergedIsWhatTheBoundSays) {
  std::mt19937 random(5);
  RandomSystem system = random_system(200, 1, 0.7, random);
  int converged = 0;
  for (const Solver solver : kSolvers) {
    for (int iterations = 1; iterations < 40; ++iterations) {
      const Radiosity result = solve(solver, system, {0.01, iterations});
      EXPECT_EQ(result.converged, result.error_bound <= 0.01) << iterations;
      EXPECT_EQ(result.cause.empty(), result.converged);
      if (result.converged) ++converged;
    }
  }
  EXPECT_GT(converged, 10);
}

// Two colours are good enough long before the third, and are not waited for.
TEST(IterateEnd, RoundingIsAskedForColourByColour) {
  std::mt19937 random(6);
  RandomSystem system = random_system(60, 1, 0.9, random);
  for (Rgb& rho : system.unknowns.rho) rho = Rgb(0.999, 0.2, 0.2);
  const Radiosity result = solve(Solver::conjugate_gradients, system, {1e-4, 1000}, kRounding);
  EXPECT_FALSE(result.converged);
  EXPECT_LT(result.iterations, 40);
  EXPECT_NE(result.cause.find("rounding"), std::string::npos) << result.cause;
}

// Squares of such numbers are beyond double precision.
TEST(IterateEnd, TinyAndHugeEmission) {
  std::mt19937 random(7);
  RandomSystem system = random_system(30, 1, 0.9, random);
  for (const Solver solver : kSolvers) {
    const Radiosity plain = solve(solver, system, {1e-6, 1000});
    for (const int exponent : {-1000, 1000}) {
      RandomSystem scaled = system;
      for (Rgb& E : scaled.unknowns.E)
        for (int c = 0; c < kChannels; ++c) E[c] = std::ldexp(E[c], exponent);
      const Radiosity result = solve(solver, scaled, {1e-6, 1000});
      EXPECT_TRUE(result.converged) << result.cause;
      EXPECT_EQ(result.iterations, plain.iterations);
      for (std::size_t i = 0; i < 30; ++i)
        for (int c = 0; c < kChannels; ++c) EXPECT_EQ(result.B[i][c], std::ldexp(plain.B[i][c], exponent));
    }
  }
}

}  // namespace
}  // namespace fluxel
