#include "solver/iterate.hpp"

#include <gtest/gtest.h>

#include "formfactor/pair_rule.hpp"
#include "solver/row_operator.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::DenseOperator;
using test_scenes::kSolvers;
using test_scenes::largest_difference;
using test_scenes::random_system;

Radiosity solve(Solver solver, RadiosityOperator& F, const Unknowns& unknowns, const StopRule& stop) {
  return solve_radiosity(solver, {F, unknowns, find_error_weights(F, unknowns)}, stop,
                         [](const IterationState&) {});
}

TEST(Iterate, TheToleranceBoundsTheTrueError) {
  std::mt19937 random(1);
  for (const Solver solver : kSolvers) {
    auto [F, unknowns] = random_system(40, 0.97, 0.95, random);
    const std::vector<Rgb> exact = F.exact_solution(unknowns);
    int before = 0;
    for (const double tolerance : {1e-1, 1e-3, 1e-6, 1e-10}) {
      const Radiosity result = solve(solver, F, unknowns, {tolerance, 1000});
      EXPECT_TRUE(result.converged);
      EXPECT_TRUE(result.cause.empty()) << result.cause;
      EXPECT_LE(result.error_bound, tolerance);
      const Rgb error = largest_difference(result.B, exact) / area_mean(unknowns, exact);
      for (int channel = 0; channel < kChannels; ++channel) EXPECT_LE(error[channel], tolerance * (1 + 1e-3));
      EXPECT_GT(result.iterations, before) << "a tighter tolerance takes more";
      before = result.iterations;
    }
  }
}

TEST(Iterate, IrradianceAndResidualBelongToTheSolution) {
  std::mt19937 random(2);
  auto [F, unknowns] = random_system(20, 0.9, 0.8, random);
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, F, unknowns, {1e-3, 1000});
    std::vector<Rgb> H(20), balance(20);
    F.apply(result.B, H);
    EXPECT_EQ(result.H, H);
    for (std::size_t i = 0; i < 20; ++i) balance[i] = unknowns.E[i] + unknowns.rho[i] * H[i];
    const Rgb residual = largest_difference(balance, result.B) / area_mean(unknowns, result.B);
    EXPECT_NEAR(result.residual, std::max({residual.r, residual.g, residual.b}), 1e-14);
  }
}

/// Rows in single precision, and the same matrix in double precision.
struct PairSystem {
  std::vector<Element> elements;
  TileStore store;
  Unknowns unknowns;

  PairSystem(const Scene& scene, double max_edge)
      : elements(test_scenes::uniform_elements(scene, max_edge).elements),
        store(test_scenes::traced(RayScene(scene, 1), elements)),
        unknowns(make_unknowns(elements, scene.materials)) {}

  [[nodiscard]] DenseOperator exact(PairRule rule) const {
    const std::size_t n = elements.size();
    const auto facing = [&](std::size_t of, std::size_t at) {
      const glm::vec3 separation = elements[at].centroid - elements[of].centroid;
      return unknowns.two_sided && glm::dot(elements[of].normal, separation) < 0 ? n + of : of;
    };
    std::vector<std::vector<double>> F(unknowns.size(), std::vector<double>(unknowns.size()));
    TileBits bits;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        store.read(i / kTileSize, j / kTileSize, bits);
        if ((bits[i % kTileSize] >> (j % kTileSize) & 1u) != 0)
          F[facing(i, j)][facing(j, i)] = pair_form_factor(rule, elements[i], elements[j]);
      }
    }
    return DenseOperator(F);
  }
};

/// Solves with a tolerance that single precision cannot hold; the true errors, for each rule and solver where
/// there is a bound, over it.
std::vector<double> errors_over_bounds(const PairSystem& system) {
  std::vector<double> ratios;
  const Corrections none;
  for (const PairRule rule : {PairRule::point, PairRule::disc, PairRule::moments}) {
    const std::vector<Rgb> exact = system.exact(rule).exact_solution(system.unknowns);
    RowOperator F(system.elements, system.store, none, rule, system.unknowns.two_sided, 1);
    const RowSums weights = find_error_weights(F, system.unknowns, kSinglePrecisionRounding);
    if (!weights.weights) continue;
    for (const Solver solver : kSolvers) {
      const Radiosity result = solve_radiosity(solver, {F, system.unknowns, weights}, {1e-12, 1'000'000},
                                               [](const IterationState&) {});
      EXPECT_FALSE(result.converged);
      EXPECT_NE(result.cause.find("single precision"), std::string::npos) << result.cause;
      const Rgb error = largest_difference(result.B, exact) / area_mean(system.unknowns, exact);
      ratios.push_back(std::max({error.r, error.g, error.b}) / result.error_bound);
    }
  }
  return ratios;
}

TEST(Iterate, TheBoundHoldsDownToTheRoundingOfSinglePrecision) {
  std::vector<double> ratios;
  for (const int n : {1, 2, 4}) {
    PairSystem cube(test_scenes::unit_cube(), 1.0 / n);
    for (const double rho : {0.5, 0.9, 0.96}) {
      cube.unknowns.rho.assign(cube.unknowns.size(), Rgb(rho));
      cube.unknowns.E.assign(cube.unknowns.size(), Rgb(0));
      for (std::size_t i = 0; i < cube.elements.size() / 6; ++i) cube.unknowns.E[i] = Rgb(1, 0.3, 7);
      std::ranges::copy(errors_over_bounds(cube), std::back_inserter(ratios));
    }
  }
  std::mt19937 random(13);
  for (const Sides sides : {Sides::one, Sides::two}) {
    PairSystem plates(test_scenes::random_plates(40, 0.7, sides, 1), 0.5);
    for (const double rho : {0.5, 0.95}) {
      for (Rgb& of : plates.unknowns.rho) of = rho * test_scenes::uniform_point(random, 0.9, 1);
      for (Rgb& E : plates.unknowns.E) E = test_scenes::uniform_point(random, 0, 1);
      std::ranges::copy(errors_over_bounds(plates), std::back_inserter(ratios));
    }
  }
  EXPECT_LT(*std::ranges::max_element(ratios), 1);
  EXPECT_GT(*std::ranges::max_element(ratios), 0.1) << "and it is no wild guess";
}

// A spectral radius of 0.9995 leaves 0.9995 of the step to the next one, again and again.
TEST(Iterate, SlowConvergenceIsNoStandstill) {
  std::mt19937 random(14);
  auto [F, unknowns] = random_system(10, 1, 0.9, random);
  for (Rgb& rho : unknowns.rho) rho = Rgb(0.9995);
  const std::vector<Rgb> exact = F.exact_solution(unknowns);
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, F, unknowns, {1e-4, 1'000'000});
    EXPECT_TRUE(result.converged) << result.cause << " after " << result.iterations;
    const Rgb error = largest_difference(result.B, exact) / area_mean(unknowns, exact);
    EXPECT_LE(std::max({error.r, error.g, error.b}), 1.001e-4);
  }
}

// A closed scene (row sums 1) with E = 1 - rho has B = 1 everywhere, whatever the reflectances.
TEST(Iterate, WhiteFurnace) {
  std::mt19937 random(3);
  auto [F, unknowns] = random_system(50, 1, 0.9, random);
  for (std::size_t i = 0; i < 50; ++i) unknowns.E[i] = Rgb(1) - unknowns.rho[i];
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, F, unknowns, {1e-9, 1000});
    EXPECT_TRUE(result.converged);
    for (const Rgb& B : result.B)
      for (int channel = 0; channel < kChannels; ++channel) EXPECT_NEAR(B[channel], 1, 1.01e-9);
  }
}

TEST(Iterate, GaussSeidelNeedsFewerIterations) {
  std::mt19937 random(4);
  auto [F, unknowns] = random_system(60, 1, 0.98, random);
  const int jacobi = solve(Solver::jacobi, F, unknowns, {1e-6, 1000}).iterations;
  const int gauss_seidel = solve(Solver::gauss_seidel, F, unknowns, {1e-6, 1000}).iterations;
  EXPECT_LT(gauss_seidel, 0.8 * jacobi);
}

TEST(Iterate, ObserversSeeEveryIteration) {
  std::mt19937 random(5);
  auto [F, unknowns] = random_system(20, 0.9, 0.8, random);
  std::vector<double> bounds;
  const Radiosity result = solve_radiosity(Solver::jacobi, {F, unknowns, find_error_weights(F, unknowns)},
                                           {1e-6, 1000}, [&](const IterationState& state) {
                                             EXPECT_EQ(state.iteration, static_cast<int>(bounds.size()) + 1);
                                             EXPECT_EQ(state.error, state.error_bound);
                                             EXPECT_EQ(state.target, 1e-6);
                                             bounds.push_back(state.error_bound);
                                           });
  EXPECT_EQ(static_cast<int>(bounds.size()), result.iterations);
  EXPECT_EQ(bounds.back(), result.error_bound);
  EXPECT_TRUE(std::ranges::is_sorted(bounds, std::greater<>()));
}

TEST(Iterate, TooFewIterationsAreNoSuccess) {
  std::mt19937 random(6);
  auto [F, unknowns] = random_system(30, 1, 0.95, random);
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, F, unknowns, {1e-9, 3});
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.iterations, 3);
    EXPECT_GT(result.error_bound, 1e-9);
    EXPECT_NE(result.cause.find("--max-iterations"), std::string::npos) << result.cause;
  }
}

TEST(Iterate, DivergenceIsRecognisedEarly) {
  std::mt19937 random(7);
  auto [F, unknowns] = random_system(30, 1.6, 0.9, random);
  for (Rgb& rho : unknowns.rho) rho = Rgb(0.1, 0.1, 0.9);  // one colour is enough
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, F, unknowns, {1e-3, 100'000});
    EXPECT_FALSE(result.converged);
    EXPECT_LT(result.iterations, 100);
    EXPECT_TRUE(std::isinf(result.error_bound));
    const bool symmetric = solver == Solver::conjugate_gradients;
    EXPECT_NE(result.cause.find(symmetric ? "not positive definite" : "diverges"), std::string::npos)
        << result.cause;
    EXPECT_NE(result.cause.find("1.6"), std::string::npos) << result.cause;
  }
}

TEST(Iterate, AnAmplifyingRowAloneDoesNotStopConvergence) {
  std::mt19937 random(8);
  auto [plain, unknowns] = random_system(30, 0.6, 0.9, random);
  // Of a third of the area, with the same exchange.
  std::vector<std::vector<double>> matrix = plain.matrix();
  for (double& entry : matrix[3]) entry *= 3;
  unknowns.area[3] /= 3;
  DenseOperator F(matrix);
  unknowns.rho[3] = Rgb(0.9);
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, F, unknowns, {1e-6, 1000});
    EXPECT_TRUE(result.converged) << result.cause;
    const std::vector<Rgb> exact = F.exact_solution(unknowns);
    const Rgb error = largest_difference(result.B, exact) / area_mean(unknowns, exact);
    for (int channel = 0; channel < kChannels; ++channel) EXPECT_LE(error[channel], 1.001e-6);
  }
}

TEST(Iterate, AColourWithoutLightStaysDark) {
  std::mt19937 random(9);
  auto [F, unknowns] = random_system(20, 0.9, 0.8, random);
  for (Rgb& E : unknowns.E) E.g = 0;
  for (const Solver solver : kSolvers) {
    const Radiosity result = solve(solver, F, unknowns, {1e-6, 1000});
    EXPECT_TRUE(result.converged);
    for (const Rgb& B : result.B) {
      EXPECT_EQ(B.g, 0);
      EXPECT_GT(B.r, 0);
    }
  }
}

TEST(Iterate, BlackSurfacesTakeOneIteration) {
  std::mt19937 random(10);
  auto [F, unknowns] = random_system(20, 1, 0.8, random);
  for (Rgb& rho : unknowns.rho) rho = Rgb(0);
  const Radiosity result = solve(Solver::jacobi, F, unknowns, {1e-9, 1000});
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_EQ(result.B, unknowns.E);
  EXPECT_GT(result.H[0].r, 0);
}

/// A sum in single precision does not settle below its rounding.
class RoundedOperator final : public RadiosityOperator {
 public:
  explicit RoundedOperator(DenseOperator exact) : exact_(std::move(exact)) {}
  void apply(std::span<const Rgb> x, std::span<Rgb> H) override {
    exact_.apply(x, H);
    for (Rgb& value : H)
      for (int channel = 0; channel < kChannels; ++channel)
        value[channel] *= 1 + test_scenes::uniform(random_, -1e-7, 1e-7);
  }
  void apply(std::span<const double> x, std::span<double> H) override { exact_.apply(x, H); }
  void sweep(std::span<const Rgb>, std::span<const Rgb>, std::span<Rgb>) override {}
  void sweep(std::span<const double>, std::span<const double>, std::span<double>) override {}

 private:
  DenseOperator exact_;
  std::mt19937 random_{11};
};

// Conjugate gradients look at the truth where their recurrence says that it is good enough, and do not look
// for ever.
TEST(Iterate, ARecurrenceBelowTheRoundingIsGivenUp) {
  std::mt19937 random(22);
  for (const Solver solver : {Solver::conjugate_gradients, Solver::southwell}) {
    auto [exact, unknowns] = random_system(30, 1, 0.9, random);
    RoundedOperator F(std::move(exact));
    const Radiosity result = solve(solver, F, unknowns, {1e-9, 100'000});
    EXPECT_FALSE(result.converged);
    // Southwell's method has to stand still for 200 iterations, conjugate gradients look twenty times in
    // vain.
    EXPECT_LT(result.iterations, solver == Solver::southwell ? 1000 : 250);
    EXPECT_NE(result.cause.find("rounding"), std::string::npos) << result.cause;
    EXPECT_LT(result.error_bound, 1e-4);
  }
}

TEST(Iterate, StandingStillAtTheRoundingIsNamed) {
  std::mt19937 random(12);
  auto [exact, unknowns] = random_system(30, 1, 0.9, random);
  RoundedOperator F(std::move(exact));
  for (Rgb& rho : unknowns.rho) rho = Rgb(0.9);
  const Radiosity result = solve(Solver::jacobi, F, unknowns, {1e-12, 100'000});
  EXPECT_FALSE(result.converged);
  EXPECT_LT(result.iterations, 1000);
  EXPECT_NE(result.cause.find("--tolerance"), std::string::npos) << result.cause;
}

// Heat may be drawn, down to a total of little more than nothing.
TEST(Iterate, NegativeEmission) {
  std::mt19937 random(21);
  for (const double drawn : {0.5, 0.95}) {
    auto [F, unknowns] = random_system(40, 1, 0.9, random);
    double sent = 0, area = 0;
    for (std::size_t i = 0; i < 40; ++i) {
      unknowns.E[i] = Rgb(i < 4 ? 1 : 0);
      (i < 4 ? sent : area) += unknowns.area[i];
    }
    for (std::size_t i = 4; i < 40; ++i) {
      unknowns.E[i] = Rgb(-drawn * sent / area);
      unknowns.rho[i] = Rgb(0.98);
    }
    const std::vector<Rgb> exact = F.exact_solution(unknowns);
    const Rgb mean = area_mean(unknowns, exact);
    ASSERT_GT(mean.r, 0);
    for (const Solver solver : kSolvers) {
      const Radiosity result = solve(solver, F, unknowns, {1e-6, 5000});
      EXPECT_TRUE(result.converged) << result.cause;
      EXPECT_LE(largest_difference(result.B, exact).r, 1.001e-6 * mean.r);
    }
  }
}

// 690 iterations of Jacobi's method and 10 of conjugate gradients were measured on a closed box.
TEST(Iterate, ConjugateGradientsNeedFewIterationsAtHighReflectance) {
  std::mt19937 random(15);
  auto [F, unknowns] = random_system(200, 1, 0.9, random);
  for (Rgb& rho : unknowns.rho) rho = Rgb(0.99);
  EXPECT_GT(solve(Solver::jacobi, F, unknowns, {1e-3, 10'000}).iterations, 400);
  const Radiosity result = solve(Solver::conjugate_gradients, F, unknowns, {1e-3, 10'000});
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.iterations, 15);
}

TEST(Iterate, TheMeanSquareBoundHoldsToo) {
  std::mt19937 random(16);
  for (const double rho_max : {0.5, 0.95}) {
    auto [F, unknowns] = random_system(60, 1, rho_max, random);
    const std::vector<Rgb> exact = F.exact_solution(unknowns);
    for (const Solver solver : kSolvers) {
      for (const double tolerance : {1e-1, 1e-4}) {
        const Radiosity result = solve(solver, F, unknowns, {tolerance, 1000});
        Rgb square(0);
        double area = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
          const Rgb error = result.B[i] - exact[i];
          square += unknowns.area[i] * error * error;
          area += unknowns.area[i];
        }
        const Rgb error = glm::sqrt(square / area) / area_mean(unknowns, result.B);
        for (int c = 0; c < kChannels; ++c) {
          EXPECT_LE(error[c], result.mean_square_bound[c] * (1 + 1e-9)) << static_cast<int>(solver);
          EXPECT_LE(result.mean_square_bound[c], result.largest_bound[c]);
          EXPECT_GT(error[c], result.mean_square_bound[c] / 100) << "and it is no wild guess";
        }
      }
    }
  }
}

TEST(Iterate, AGreySceneIsSolvedInOneChannel) {
  std::mt19937 random(17);
  auto [F, unknowns] = random_system(40, 1, 0.9, random);
  for (Rgb& rho : unknowns.rho) rho = Rgb(rho.r);
  for (Rgb& E : unknowns.E) E = Rgb(E.r);
  Unknowns coloured = unknowns;
  for (Rgb& E : coloured.E) E.g *= 2;
  for (const Solver solver : kSolvers) {
    const Radiosity one = solve(solver, F, unknowns, {1e-6, 1000});
    const Radiosity three = solve(solver, F, coloured, {1e-6, 1000});
    EXPECT_EQ(one.channels, 1);
    EXPECT_EQ(three.channels, 3);
    EXPECT_EQ(one.iterations, three.iterations);
    for (std::size_t i = 0; i < one.B.size(); ++i) {
      EXPECT_EQ(one.B[i], Rgb(three.B[i].r));
      EXPECT_EQ(one.H[i], Rgb(three.H[i].r));
      EXPECT_EQ(three.B[i].g, 2 * three.B[i].r);
    }
  }
}

// A colour that needs few iterations gets the same bytes whatever the others need.
TEST(Iterate, EachColourOfConjugateGradientsHasItsOwnEnd) {
  std::mt19937 random(18);
  auto [F, unknowns] = random_system(40, 1, 0.9, random);
  for (Rgb& rho : unknowns.rho) rho = Rgb(0.3 * rho.r, 0.3 * rho.r, 0.3 * rho.r);
  Unknowns slow = unknowns;
  for (Rgb& rho : slow.rho) rho.b = 0.99;
  const RowSums bounds = find_error_weights(F, slow);  // hold for smaller reflectances, too
  // clang before 16 captures no structured binding by itself.
  const auto solved = [&, &F = F](const Unknowns& of) {
    return solve_radiosity(Solver::conjugate_gradients, {F, of, bounds}, {1e-3, 1000},
                           [](const IterationState&) {});
  };
  const Radiosity alone = solved(unknowns), together = solved(slow);
  ASSERT_GT(together.iterations, alone.iterations);
  ASSERT_TRUE(together.converged);
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(together.B[i].r, alone.B[i].r);
}

TEST(Iterate, AWarmStartSavesIterations) {
  std::mt19937 random(19);
  auto [F, unknowns] = random_system(40, 1, 0.95, random);
  unknowns.rho[5] = Rgb(0);
  for (const Solver solver : kSolvers) {
    const StopRule stop{1e-6, 1000};
    const RowSums sums = find_error_weights(F, unknowns);
    const auto from = [&, &F = F, &unknowns = unknowns](const std::vector<Rgb>& start) {
      return solve_radiosity(
          solver, {F, unknowns, sums}, stop, [](const IterationState&) {}, start);
    };
    const Radiosity cold = solve(solver, F, unknowns, stop);
    std::vector<Rgb> start = F.exact_solution(unknowns);
    start[5] = Rgb(7);  // where nothing is reflected B = E, whatever the start says
    const Radiosity warm = from(start);
    EXPECT_TRUE(warm.converged);
    EXPECT_EQ(warm.iterations, 1);
    EXPECT_EQ(warm.B[5], unknowns.E[5]);
    std::vector<Rgb> wild(start.size());
    for (Rgb& B : wild) B = test_scenes::uniform_point(random, -5, 20);
    const Radiosity from_anywhere = from(wild);
    EXPECT_TRUE(from_anywhere.converged);
    const Rgb difference = largest_difference(from_anywhere.B, cold.B) / area_mean(unknowns, cold.B);
    for (int c = 0; c < kChannels; ++c) EXPECT_LE(difference[c], 2.001e-6);
  }
}

TEST(Iterate, TheFirstShotsLightUpMost) {
  std::mt19937 random(20);
  auto [F, unknowns] = random_system(640, 1, 0.6, random);
  for (std::size_t i = 0; i < 640; ++i) unknowns.E[i] = Rgb(i < 3 ? 1 : 0);
  // One iteration has shot the emitters' own light, as Jacobi's first does.
  const Radiosity shot = solve(Solver::southwell, F, unknowns, {1e-9, 1});
  const Radiosity jacobi = solve(Solver::jacobi, F, unknowns, {1e-9, 1});
  EXPECT_EQ(shot.B, jacobi.B);
}

}  // namespace
}  // namespace fluxel
