#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cstdio>

#include "bench/stability/lit_rooms.hpp"
#include "core/options.hpp"
#include "solver/channels.hpp"
#include "tests/stability/world.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel::lab {
namespace {

using test::world;

constexpr Solver kSolvers[] = {Solver::jacobi, Solver::gauss_seidel, Solver::conjugate_gradients,
                               Solver::southwell};
constexpr const char* kNames[] = {"automatic", "Jacobi", "Gauss-Seidel", "conjugate gradients", "Southwell"};

const char* name_of(Solver solver) { return kNames[static_cast<std::size_t>(solver)]; }

FormFactorOptions closed() {
  FormFactorOptions options;
  options.closure = true;
  return options;
}

/// F as the solvers use it, column by column.
Eigen::MatrixXd dense(RadiosityOperator& F, std::size_t n) {
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd matrix(size, size);
  std::vector<double> unit(n, 0.0), column(n);
  for (std::size_t j = 0; j < n; ++j) {
    unit[j] = 1;
    F.apply(unit, column);
    unit[j] = 0;
    matrix.col(static_cast<Eigen::Index>(j)) = Eigen::Map<const Eigen::VectorXd>(column.data(), size);
  }
  return matrix;
}

/// (I - rho F) B = E by Gaussian elimination with pivoting, in double precision.
std::vector<Rgb> eliminated(const Eigen::MatrixXd& F, const Unknowns& unknowns) {
  std::vector<Rgb> B(unknowns.size());
  const bool grey = is_grey({}, unknowns);
  for (int c = 0; c < (grey ? 1 : kChannels); ++c) {
    Eigen::VectorXd rho(F.rows()), E(F.rows());
    for (Eigen::Index i = 0; i < F.rows(); ++i) {
      rho[i] = unknowns.rho[static_cast<std::size_t>(i)][c];
      E[i] = unknowns.E[static_cast<std::size_t>(i)][c];
    }
    Eigen::MatrixXd system = -(rho.asDiagonal() * F);
    system.diagonal().array() += 1;
    const Eigen::VectorXd solution = Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>>(system).solve(E);
    for (std::size_t i = 0; i < B.size(); ++i) B[i][c] = solution[static_cast<Eigen::Index>(i)];
    if (grey)
      for (Rgb& value : B) value = Rgb(value.r);
  }
  return B;
}

/// max |B - B*| over the area-mean of B*, the largest over the colours: what the solvers bound.
double error_of(const Unknowns& unknowns, const std::vector<Rgb>& B, const std::vector<Rgb>& exact) {
  const Rgb mean = area_mean(unknowns, exact);
  double largest = 0;
  for (std::size_t i = 0; i < B.size(); ++i)
    largest = std::max(largest, largest_channel(glm::abs(B[i] - exact[i]) / mean));
  return largest;
}

/// The same, but over the reflected part of B* where that is larger than the mean: single precision rounds
/// what an element gets relative to it, so next to a lamp more than elsewhere.
double disagreement(const Unknowns& unknowns, const std::vector<Rgb>& B, const std::vector<Rgb>& exact) {
  const Rgb mean = area_mean(unknowns, exact);
  double largest = 0;
  for (std::size_t i = 0; i < B.size(); ++i) {
    const Rgb scale = glm::max(mean, exact[i] - unknowns.E[i]);
    largest = std::max(largest, largest_channel(glm::abs(B[i] - exact[i]) / scale));
  }
  return largest;
}

/// The cluttered room, small enough for elimination.
struct Room {
  Prepared prepared;
  Eigen::MatrixXd F;

  explicit Room(double max_edge)
      : prepared(world(), lit_room(LitRoom::cluttered, max_edge), closed()),
        F(dense(prepared.matrix.factors(), prepared.unknowns.size())) {}

  [[nodiscard]] Radiosity solve(Solver solver, const Unknowns& unknowns, double rounding, double tolerance) {
    const RowSums row_sums = find_error_weights(prepared.matrix.factors(), unknowns, rounding);
    return solve_radiosity(solver, {prepared.matrix.factors(), unknowns, row_sums}, {tolerance, 20000},
                           [](const IterationState&) {});
  }
};

Unknowns coloured(const Room& room) {
  Unknowns unknowns = room.prepared.unknowns;
  mix_reflectances(room.prepared, 0.2, 0.9, unknowns);
  light(room.prepared, "lamp", {10, 7, 4}, unknowns);
  return unknowns;
}

/// Solves as far as single precision goes, where the bound is to come to `reachable`.
void expect_agreement(Room& room, const Unknowns& unknowns, double reachable) {
  const std::vector<Rgb> exact = eliminated(room.F, unknowns);
  for (const Solver solver : kSolvers) {
    const Radiosity found = room.solve(solver, unknowns, 0, 3e-7);
    const double off = disagreement(unknowns, found.B, exact);
    std::printf("%zu elements, %s: %d iterations, bound %.2g, off %.2g, %.2g of the mean\n", unknowns.size(),
                name_of(solver), found.iterations, found.error_bound, off,
                error_of(unknowns, found.B, exact));
    EXPECT_LE(found.error_bound, reachable) << name_of(solver) << ": " << found.cause;
    EXPECT_LE(off, 1e-6) << name_of(solver);
  }
}

TEST(AgainstElimination, EverySolverInAColouredRoom) {
  Room room(0.6);
  // The residual jumps by what single precision rounds, 1e-7 of the mean, times 1 / (1 - 0.9).
  // Narrower vectors make longer sums: with AVX-512 bounds come to 1e-6, with AVX2 Southwell's to 2.2e-6.
  const double reachable = instruction_set_in_use() == "avx512" ? 1e-6 : 2.5e-6;
  expect_agreement(room, coloured(room), reachable);
}

TEST(AgainstElimination, EverySolverInABrightRoom) {
  Room room(0.7);  // for Southwell's thousands of iterations
  Unknowns unknowns = room.prepared.unknowns;
  set_reflectance(0.99, unknowns);
  light(room.prepared, "lamp", Rgb(10), unknowns);
  // Here times 1 / (1 - 0.99). Only conjugate gradients and Southwell's method look at it; Jacobi's steps
  // come to nothing.
  expect_agreement(room, unknowns, 3e-5);
}

// Of an ordinary run, which stops far from the best.
TEST(AgainstElimination, TheErrorIsBelowItsBound) {
  Room room(0.7);
  const Unknowns unknowns = coloured(room);
  const std::vector<Rgb> exact = eliminated(room.F, unknowns);
  for (const Solver solver : kSolvers) {
    for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
      const Radiosity found = room.solve(solver, unknowns, kSinglePrecisionRounding, tolerance);
      const double error = error_of(unknowns, found.B, exact);
      std::printf("%s: bound %.2g, error %.2g\n", name_of(solver), found.error_bound, error);
      EXPECT_LE(error, found.error_bound) << name_of(solver);
      EXPECT_EQ(found.converged, found.error_bound <= tolerance) << name_of(solver);
    }
  }
}

/// Solves at rho = 0.99 to 1e-3, as a run does, and holds the error against a solution that is far better.
Radiosity solve_bright(LitRoom kind, double max_edge, const FormFactorOptions& form_factor) {
  Prepared room(world(), lit_room(kind, max_edge), form_factor);
  RadiosityOperator& F = room.matrix.factors();
  set_reflectance(0.99, room.unknowns);
  light(room, "lamp", Rgb(10), room.unknowns);
  const auto observer = [](const IterationState&) {};
  const Radiosity best =
      solve_radiosity(Solver::conjugate_gradients, {F, room.unknowns, find_error_weights(F, room.unknowns)},
                      {1e-5, 1000}, observer);
  EXPECT_TRUE(best.converged) << best.cause;
  Radiosity found =
      solve_radiosity(Solver::conjugate_gradients,
                      {F, room.unknowns, find_error_weights(F, room.unknowns, kSinglePrecisionRounding)},
                      {1e-3, 1000}, observer);
  EXPECT_TRUE(found.converged) << found.cause;
  const double error = error_of(room.unknowns, found.B, best.B);
  std::printf("%zu elements: %d iterations, bound %.2g, error %.2g\n", room.unknowns.size(), found.iterations,
              found.error_bound, error);
  EXPECT_LE(error, found.error_bound + best.error_bound);
  return found;
}

// The spectrum of a closed convex room is one eigenvalue near rho and many small ones.
TEST(ConjugateGradients, TakeFewIterationsInABrightBox) {
  EXPECT_LE(solve_bright(LitRoom::box, 0.45, closed()).iterations, 15);
  EXPECT_LE(solve_bright(LitRoom::box, 0.15, closed()).iterations, 15);
}

// Two eigenvalues near rho: light spreads in each room and, slowly, through the door.
TEST(ConjugateGradients, TakeFewIterationsThroughADoor) {
  EXPECT_LE(solve_bright(LitRoom::two_rooms, 0.25, closed()).iterations, 30);
}

}  // namespace
}  // namespace fluxel::lab
