#include "metrics/known_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fluxel {
namespace {

TEST(KnownError, WhatIsExpectedAloneIsStatedWithItsSpread) {
  const auto known = known_error(0.02, std::nullopt);
  ASSERT_TRUE(known);
  EXPECT_DOUBLE_EQ(known->likely, 0.02);
  // sqrt(1 + 1.341 * 1.3) of it
  EXPECT_NEAR(known->most, 0.0331255, 1e-6);
  EXPECT_EQ(known->least, 0) << "a rough estimate excludes nothing below it";
}

TEST(KnownError, WhatIsMeasuredAloneIsTakenAsItIs) {
  const auto known = known_error(std::nullopt, MeasuredSquare{4e-4, 1e-4});
  ASSERT_TRUE(known);
  EXPECT_DOUBLE_EQ(known->likely, 0.02);
  EXPECT_NEAR(known->most, std::sqrt(4e-4 + 1.341e-4), 1e-12);
  EXPECT_NEAR(known->least, std::sqrt(4e-4 - 1.341e-4), 1e-12);
  const auto hidden = known_error(std::nullopt, MeasuredSquare{-1e-4, 3e-4});
  EXPECT_EQ(hidden->likely, 0);
  EXPECT_NEAR(hidden->most, std::sqrt(4.023e-4), 1e-12) << "a square is not negative";
  EXPECT_GT(known_error(0.047, MeasuredSquare{-5e-4, 2e-4})->most, 0.016) << "no error is 0 for certain";
}

TEST(KnownError, TheBetterKnownOneCountsMore) {
  const auto rough = known_error(0.02, MeasuredSquare{9e-4, 1e-2});
  EXPECT_NEAR(rough->likely, 0.02, 1e-4) << "noise tells nothing";
  const auto exact = known_error(0.02, MeasuredSquare{9e-4, 1e-6});
  EXPECT_NEAR(exact->likely, 0.03, 1e-4);
  EXPECT_LT(exact->most, 0.0301);
  EXPECT_LT(known_error(0.02, MeasuredSquare{4e-4, 3e-4})->most, known_error(0.02, std::nullopt)->most);
}

TEST(KnownError, WhatIsMeasuredCountsAloneWhereBothCannotBeSo) {
  // 5 +- 0.5 % where 1 % is expected: inverse variances would make it 1.4 %.
  const auto known = known_error(0.01, MeasuredSquare{25e-4, 5e-4});
  EXPECT_DOUBLE_EQ(known->likely, 0.05);
  EXPECT_LT(known_error(0.01, MeasuredSquare{25e-4, 1e-3})->likely, 0.015) << "which noise may be";
}

TEST(KnownError, OfSeveralColoursTheLargestCounts) {
  const auto known = larger(KnownError{0.01, 0, 0.05}, KnownError{0.02, 0.015, 0.025});
  EXPECT_EQ(known->likely, 0.02);
  EXPECT_EQ(known->least, 0.015);
  EXPECT_EQ(known->most, 0.05);
  EXPECT_EQ(larger(std::nullopt, KnownError{0.01, 0, 0.02})->likely, 0.01);
  EXPECT_FALSE(larger(std::nullopt, std::nullopt));
  EXPECT_FALSE(known_error(std::nullopt, std::nullopt));
}

// True errors around what is expected by a factor whose logarithm has a standard deviation of 0.4, as those
// of random rooms: nine of ten are at most what is stated, whatever the noise of what is measured.
TEST(KnownError, NineOfTenErrorsAreAtMostWhatIsStated) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double noise : {0.1, 0.5, 2.0, 10.0}) {
    int kept = 0, within = 0;
    constexpr int kTrials = 4000;
    for (int trial = 0; trial < kTrials; ++trial) {
      const double truth = 0.01 * std::exp(0.4 * normal(random));
      const double error = noise * 1e-4;
      const auto known = known_error(0.01, MeasuredSquare{truth * truth + error * normal(random), error});
      if (truth <= known->most) ++kept;
      if (truth <= 1.5 * known->most) ++within;
    }
    EXPECT_NEAR(kept / double{kTrials}, 0.9, 0.05) << noise;
    EXPECT_GT(within / double{kTrials}, 0.98) << noise;
  }
}

TEST(KnownError, NoiseFallsByTheRootOfTwoWithAsManyAgain) {
  EXPECT_DOUBLE_EQ(most_after_as_many_again({1, 0.5, 1}), 1);
  EXPECT_DOUBLE_EQ(most_after_as_many_again({1, 0.5, 3}), 1 + std::sqrt(2.0));
}

}  // namespace
}  // namespace fluxel
