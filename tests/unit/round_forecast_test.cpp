#include "metrics/round_forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fluxel {
namespace {

TEST(RoundForecast, TheNextBlockErrorIsAsSmallAsTheErrorAsksFor) {
  // 0.7 of the target is aimed at, and the error is as the root of the block error.
  EXPECT_NEAR(next_block_error(1, 0.014, 0.01), 1 / 4.0, 1e-12);
  EXPECT_NEAR(next_block_error(1e-3, 0.0175, 0.01), 1e-3 / 6.25, 1e-12);
  // Never less than a third, nor more than an eighth, at once.
  EXPECT_NEAR(next_block_error(1, 0.001, 0.01), 1 / 3.0, 1e-12);
  EXPECT_NEAR(next_block_error(1, 0.1, 0.01), 1 / 8.0, 1e-12);
}

TEST(RoundForecast, ASingleRoundGrowsAsItsBlockErrorFalls) {
  const std::vector<RoundSample> rounds{{8e-3, 100, 5000, 3}};
  const RoundSample next = forecast_round(rounds, 2e-3);
  EXPECT_EQ(next.block_error, 2e-3);
  EXPECT_NEAR(next.links, 400, 1e-9);
  EXPECT_NEAR(next.bytes, 20000, 1e-6);
  EXPECT_NEAR(next.seconds, 12, 1e-12);
}

TEST(RoundForecast, EachQuantityGrowsAsBetweenTheLastTwoRounds) {
  // Powers of 0.75, 0.5 and 1 of a block error that falls to a sixteenth; what was before does not count.
  const std::vector<RoundSample> rounds{{1, 1e6, 1e6, 1e6}, {1.6e-1, 100, 1000, 1}, {1e-2, 800, 4000, 16}};
  const RoundSample next = forecast_round(rounds, 1e-2 / 4);
  EXPECT_NEAR(next.links, 800 * std::pow(4, 0.75), 1e-9);
  EXPECT_NEAR(next.bytes, 4000 * 2, 1e-9);
  EXPECT_NEAR(next.seconds, 16 * 4, 1e-9);
}

TEST(RoundForecast, WhatHardlyGrowsOrLeapsIsNotTakenForALaw) {
  const std::vector<RoundSample> rounds{{4e-2, 100, 0, 5}, {1e-2, 100'000, 0, 4}};
  const RoundSample next = forecast_round(rounds, 1e-2 / 4);
  EXPECT_NEAR(next.links, 100'000 * std::pow(4, 1.25), 1e-6);
  EXPECT_EQ(next.bytes, 0) << "nothing is known of it";
  EXPECT_NEAR(next.seconds, 4 * 2, 1e-12);
}

TEST(RoundForecast, RoundsToComeAddUpInTime) {
  const std::vector<RoundSample> rounds{{1.6e-1, 100, 1000, 1}, {1e-2, 800, 4000, 16}};
  const RoundSample sum = forecast_rounds(rounds, std::vector{1e-2 / 4, 1e-2 / 16});
  EXPECT_EQ(sum.block_error, 1e-2 / 16);
  EXPECT_NEAR(sum.links, 800 * std::pow(16, 0.75), 1e-9);
  EXPECT_NEAR(sum.bytes, 4000 * 4, 1e-9);
  EXPECT_NEAR(sum.seconds, 16 * 4 + 16 * 16, 1e-9);
  // Without any it is the last one that was made, and takes no time.
  const RoundSample none = forecast_rounds(rounds, {});
  EXPECT_EQ(none.links, 800);
  EXPECT_EQ(none.bytes, 4000);
  EXPECT_EQ(none.seconds, 0);
}

}  // namespace
}  // namespace fluxel
