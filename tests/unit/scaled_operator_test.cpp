#include "solver/scaled_operator.hpp"

#include <gtest/gtest.h>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::DenseOperator;
using test_scenes::uniform;

constexpr std::size_t kSize = 25;

/// A matrix, a scale, and the product in full.
struct ScaledSystem {
  std::mt19937 random{1};
  std::vector<std::vector<double>> matrix = test_scenes::random_matrix(kSize, 0.8, random);
  std::vector<double> scale;
  DenseOperator F{matrix};

  ScaledSystem() {
    for (std::size_t i = 0; i < kSize; ++i) scale.push_back(std::exp(uniform(random, -1, 1)));
  }

  [[nodiscard]] DenseOperator in_full() const {
    auto full = matrix;
    for (std::size_t i = 0; i < kSize; ++i)
      for (std::size_t j = 0; j < kSize; ++j) full[i][j] *= scale[i] * scale[j];
    return DenseOperator(full);
  }

  std::vector<Rgb> vector() {
    std::vector<Rgb> x(kSize);
    for (Rgb& value : x) value = test_scenes::uniform_point(random, 0, 1);
    return x;
  }
};

void expect_equal(std::span<const Rgb> a, std::span<const Rgb> b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(a[i][c], b[i][c], 1e-14 * (1 + std::abs(b[i][c])));
}

TEST(ScaledOperator, AppliesTheProduct) {
  ScaledSystem system;
  ScaledOperator scaled(system.F, system.scale);
  DenseOperator full = system.in_full();
  const std::vector<Rgb> x = system.vector();
  std::vector<Rgb> H(kSize, Rgb(-7)), exact(kSize);
  scaled.apply(x, H);
  full.apply(x, exact);
  expect_equal(H, exact);
  EXPECT_EQ(scaled.scale(), system.scale);
}

TEST(ScaledOperator, SweepsWithTheNewestValues) {
  ScaledSystem system;
  ScaledOperator scaled(system.F, system.scale);
  DenseOperator full = system.in_full();
  const std::vector<Rgb> E = system.vector(), rho = system.vector();
  std::vector<Rgb> x = system.vector(), exact = x;
  for (int repeat = 0; repeat < 2; ++repeat) {
    scaled.sweep(E, rho, x);
    full.sweep(E, rho, exact);
  }
  expect_equal(x, exact);
}

TEST(ScaledOperator, OnesChangeNothing) {
  ScaledSystem system;
  ScaledOperator scaled(system.F, std::vector<double>(kSize, 1.0));
  const std::vector<Rgb> x = system.vector();
  std::vector<Rgb> H(kSize), exact(kSize);
  scaled.apply(x, H);
  system.F.apply(x, exact);
  EXPECT_EQ(H, exact);
}

TEST(ScaledOperator, ScalesMayBeNested) {
  ScaledSystem system;
  ScaledOperator once(system.F, system.scale);
  std::vector<double> inverse;
  for (const double scale : system.scale) inverse.push_back(1 / scale);
  ScaledOperator back(once, inverse);
  const std::vector<Rgb> x = system.vector();
  std::vector<Rgb> H(kSize), exact(kSize);
  back.apply(x, H);
  system.F.apply(x, exact);
  expect_equal(H, exact);
}

}  // namespace
}  // namespace fluxel
