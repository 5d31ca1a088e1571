#include "solver/side_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

struct UnevenSides {
  Unknowns unknowns;
  std::vector<Rgb> B;
};

/// A few sides have most of the area, others most of the power; some are no unknowns.
UnevenSides uneven_sides(std::size_t count) {
  std::mt19937 random(3);
  UnevenSides sides;
  sides.unknowns.elements = count;
  for (std::size_t k = 0; k < count; ++k) {
    const double area = k % 11 == 10 ? 0 : std::exp(test_scenes::uniform(random, -4, 4));
    sides.unknowns.area.push_back(area);
    sides.unknowns.E.emplace_back(0);
    sides.unknowns.rho.emplace_back(area > 0 ? 0.5 : 0);
    sides.unknowns.active += area > 0 ? 1 : 0;
    sides.B.emplace_back(area > 0 ? std::exp(test_scenes::uniform(random, -5, 5)) : 0);
  }
  return sides;
}

TEST(SideSamples, OfFewSidesAreAll) {
  const UnevenSides sides = uneven_sides(1000);
  const std::vector<SideSample> samples = choose_sides(sides.unknowns, sides.B);
  ASSERT_EQ(samples.size(), sides.unknowns.active);
  for (const SideSample& sample : samples) {
    EXPECT_EQ(sample.weight, 1);
    EXPECT_GT(sides.unknowns.area[sample.unknown], 0);
  }
}

TEST(SideSamples, OfManyStandForAll) {
  for (const bool dark : {false, true}) {
    UnevenSides sides = uneven_sides(100000);
    if (dark) sides.B.assign(sides.B.size(), Rgb(0));
    const std::vector<SideSample> samples = choose_sides(sides.unknowns, sides.B);
    std::uint64_t draws = 0;
    double area = 0, power = 0, some = 0, whole_area = 0, whole_power = 0, whole_some = 0;
    const auto of_side = [&](std::size_t k) { return sides.unknowns.area[k] * sides.B[k].g; };
    for (const SideSample& sample : samples) {
      draws += sample.draws;
      area += sample.weight * sides.unknowns.area[sample.unknown];
      power += sample.weight * of_side(sample.unknown);
      if (sample.unknown % 3 == 0) some += sample.weight * of_side(sample.unknown);
    }
    for (std::size_t k = 0; k < sides.B.size(); ++k) {
      whole_area += sides.unknowns.area[k];
      whole_power += of_side(k);
      if (k % 3 == 0) whole_some += of_side(k);
    }
    EXPECT_EQ(draws, kSampledSides);
    EXPECT_LT(samples.size(), kSampledSides + 1);
    EXPECT_NEAR(area, whole_area, 0.05 * whole_area);
    EXPECT_NEAR(power, whole_power, 0.05 * whole_power);
    EXPECT_NEAR(some, whole_some, 0.08 * whole_some);
  }
}

TEST(SideSamples, WhatRowSumsMissIsThatOfAll) {
  const UnevenSides sides = uneven_sides(50000);
  std::vector<SideSample> samples = choose_sides(sides.unknowns, sides.B);
  std::vector<double> sums(sides.B.size(), 0.7);
  for (SideSample& sample : samples) sample.view = {0.25F, 0.05F};
  EXPECT_NEAR(closure_defect_rms(sides.unknowns, sums, samples), 0, 1e-6);
  for (double& sum : sums) sum = 0.9;
  EXPECT_NEAR(closure_defect_rms(sides.unknowns, sums, samples), 0.2, 1e-6);
  EXPECT_FALSE(is_closed(samples));
  for (SideSample& sample : samples) sample.view.escape = 0;
  EXPECT_TRUE(is_closed(samples));
}

}  // namespace
}  // namespace fluxel
