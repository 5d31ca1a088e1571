#include "solver/refinement_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/exponential.hpp>
#include <random>

#include "solver/unknowns.hpp"

namespace fluxel {
namespace {

/// B of squares in rows of n, four of which, one after another, are one of the next coarser mesh: the order
/// of a bisection tree of squares.
using Field = std::function<double(double x, double y, int n)>;

/// Column and row of the k-th square in depth-first order: every second bit of k.
std::pair<int, int> place(unsigned k) {
  int x = 0, y = 0;
  for (int bit = 0; bit < 16; ++bit) {
    x |= static_cast<int>(k >> (2 * bit) & 1u) << bit;
    y |= static_cast<int>(k >> (2 * bit + 1) & 1u) << bit;
  }
  return {x, y};
}

/// The mean of the truth over each square plus the mesh's own error there.
MeshRadiosity mesh_of(int n, const Field& error, double brightness = 1) {
  MeshRadiosity mesh;
  for (unsigned k = 0; k < static_cast<unsigned>(n * n); ++k) {
    const auto [x, y] = place(k);
    const double u = (x + 0.5) / n, v = (y + 0.5) / n;
    mesh.area.push_back(1.0 / (n * n));
    mesh.B.emplace_back(brightness * (1 + u - 0.5 + (v - 0.5) / 2 + error(u, v, n)));
  }
  return mesh;
}

CoarserRadiosity coarser_of(int n, const Field& error, double brightness = 1) {
  CoarserRadiosity coarser{mesh_of(n, error, brightness), {}};
  for (int i = 0; i <= n * n; ++i) coarser.first.push_back(static_cast<std::uint32_t>(4 * i));
  return coarser;
}

/// The estimate for rows of 128, and what it is of the truth.
struct Trial {
  RefinementError estimate;
  double ratio;
};

Trial try_field(const Field& error) {
  const MeshRadiosity fine = mesh_of(128, error);
  const std::vector<CoarserRadiosity> coarser{coarser_of(64, error), coarser_of(32, error)};
  double square = 0;
  for (unsigned k = 0; k < 128 * 128; ++k) {
    const auto [x, y] = place(k);
    square += std::pow(error((x + 0.5) / 128, (y + 0.5) / 128, 128), 2) / (128 * 128);
  }
  const RefinementError estimate = refinement_error(fine, coarser);
  return {estimate, estimate.error.r / std::sqrt(square)};
}

double wave(double x, double y) { return std::sin(3 * x) * std::cos(2 * y); }

// Richardson's extrapolation is exact for them but for what an average over four squares takes away.
TEST(RefinementError, OfSmoothErrorsOfAnyOrder) {
  for (const double order : {0.6, 1.0, 1.5, 1.9}) {
    const Trial trial =
        try_field([&](double x, double y, int n) { return 0.3 * std::pow(n, -order) * wave(x, y); });
    EXPECT_NEAR(*trial.estimate.order, order, 0.01);
    EXPECT_NEAR(trial.estimate.survival, 1, 0.01);
    EXPECT_NEAR(trial.estimate.alignment, 1, 0.01);
    EXPECT_NEAR(trial.ratio, 1, 0.03) << order;
  }
}

// Errors that are independent from square to square and from mesh to mesh: half of them survive an average of
// four. With errors 2^p times larger on the next mesh |D1|^2 is (1/4 + 4^p) times the finest's.
TEST(RefinementError, OfNoise) {
  for (const double order : {0.5, 1.0, 1.5}) {
    const Trial trial = try_field([&](double x, double y, int n) {
      std::seed_seq seed{static_cast<int>(x * 4096), static_cast<int>(y * 4096), n};
      std::minstd_rand random(seed);
      return std::normal_distribution<double>(0, 0.3 * std::pow(n, -order))(random);
    });
    EXPECT_NEAR(*trial.estimate.order, order, 0.1);
    EXPECT_GT(trial.ratio, 0.8) << order;
    EXPECT_LT(trial.ratio, 1.25) << order;
  }
}

TEST(RefinementError, IsHeldToOrdersThatMeshesCanShow) {
  const Trial slow =
      try_field([](double x, double y, int n) { return 0.3 * std::pow(n, -0.1) * wave(x, y); });
  EXPECT_NEAR(*slow.estimate.order, 0.1, 0.01);
  const Trial fast = try_field([](double x, double y, int n) { return 9 * std::pow(n, -4.0) * wave(x, y); });
  EXPECT_NEAR(*fast.estimate.order, 4, 0.02);
  // |D1| = (2^p - 1) |error|, taken for (2^clamped - 1) |error|.
  EXPECT_NEAR(slow.ratio, (std::exp2(0.1) - 1) / (std::sqrt(2.0) - 1), 0.02);
  EXPECT_NEAR(fast.ratio, 15.0 / 3, 0.15);
}

TEST(RefinementError, OfTwoMeshesTakesTheFirstOrder) {
  const Field error = [](double x, double y, int n) { return 0.3 / n * wave(x, y); };
  const std::vector<CoarserRadiosity> coarser{coarser_of(64, error)};
  const RefinementError of_two = refinement_error(mesh_of(128, error), coarser);
  EXPECT_FALSE(of_two.order.has_value());
  EXPECT_NEAR(of_two.error.r / try_field(error).estimate.error.r, 1, 0.03);
}

TEST(RefinementError, IsRelativeToTheMeanAndZeroWhereNothingChanges) {
  const Field error = [](double x, double y, int n) { return 0.3 / n * wave(x, y); };
  const std::vector<CoarserRadiosity> dim{coarser_of(64, error), coarser_of(32, error)};
  const std::vector<CoarserRadiosity> bright{coarser_of(64, error, 1e6), coarser_of(32, error, 1e6)};
  EXPECT_NEAR(refinement_error(mesh_of(128, error, 1e6), bright).error.g,
              refinement_error(mesh_of(128, error), dim).error.g, 1e-9);
  // A constant is the same on all meshes.
  MeshRadiosity even = mesh_of(128, error);
  for (Rgb& B : even.B) B = Rgb(2, 0, 1);
  std::vector<CoarserRadiosity> even_too = dim;
  for (CoarserRadiosity& coarser : even_too)
    for (Rgb& B : coarser.radiosity.B) B = Rgb(2, 0, 1);
  EXPECT_EQ(refinement_error(even, even_too).error, Rgb(0));
}

// An iteration that has stopped right where it started from shows no difference at all.
TEST(RefinementError, WhatTheIterationHasLeftIsNotTakenForAccuracy) {
  const Field error = [](double x, double y, int n) { return 0.3 / n * wave(x, y); };
  const std::vector<CoarserRadiosity> coarser{coarser_of(64, error), coarser_of(32, error)};
  MeshRadiosity stopped = mesh_of(128, error);
  for (std::size_t i = 0; i < stopped.B.size(); ++i) {
    const auto whole = std::ranges::upper_bound(coarser[0].first, static_cast<std::uint32_t>(i)) - 1;
    stopped.B[i] = coarser[0].radiosity.B[static_cast<std::size_t>(whole - coarser[0].first.begin())];
  }
  const MeshRadiosity solved = mesh_of(128, error);
  const Rgb mean = area_mean(solved.area, solved.B);
  Rgb left(0);
  for (std::size_t i = 0; i < solved.B.size(); ++i) {
    const Rgb off = (solved.B[i] - stopped.B[i]) / mean;
    left += off * off / static_cast<double>(solved.B.size());
  }
  left = glm::sqrt(left);
  const Rgb estimate = refinement_error(solved, coarser).error;
  EXPECT_LT(refinement_error(stopped, coarser).error.g, 0.1 * estimate.g);
  EXPECT_GT(refinement_error(stopped, coarser, left).error.g, 0.9 * estimate.g);
}

TEST(RefinementError, AveragesByAreaOnBothSides) {
  // Three elements of two sides; the second has no back.
  const MeshRadiosity fine{{1, 3, 2, 1, 0, 2}, {Rgb(4), Rgb(8), Rgb(5), Rgb(1), Rgb(9), Rgb(2)}};
  const std::vector<std::uint32_t> first{0, 2, 3};
  const MeshRadiosity coarse = averaged(fine, first);
  EXPECT_EQ(coarse.area, (std::vector<double>{4, 2, 1, 2}));
  EXPECT_EQ(coarse.B, (std::vector<Rgb>{Rgb(7), Rgb(5), Rgb(1), Rgb(2)}));
  const std::vector<std::uint32_t> dark{0, 1, 2, 3};
  EXPECT_EQ(averaged(fine, dark).B[4], Rgb(0)) << "no unknown, no radiosity";
}

}  // namespace
}  // namespace fluxel
