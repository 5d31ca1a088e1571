#include "final_gather/irradiance_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/sampling.hpp"

namespace fluxel {
namespace {

constexpr int kWidth = 48, kHeight = 32;

std::size_t at(int x, int y) { return static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x); }

/// A wall of 1 cm a pixel that all pixels see.
std::vector<SeenSurface> wall() {
  std::vector<SeenSurface> seen;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) seen.push_back({{0.01 * x, 0.01 * y, 0}, {0, 0, 1}, 0});
  return seen;
}

/// In [-1, 1), of a mean square of a third.
double noise(std::uint64_t seed) { return 2 * static_cast<double>(random_bits(seed) >> 11) * 0x1p-53 - 1; }

/// Light that is off by up to `off` in each half.
IrradianceHalves measured(const std::function<double(int, int)>& light, double off) {
  IrradianceHalves halves;
  for (std::uint64_t half = 0; half < 2; ++half)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        halves[half].push_back(Rgb(1, 0.5, 0.25) * (light(x, y) + off * noise(2 * at(x, y) + half)));
  return halves;
}

std::vector<Rgb> mean_of(const IrradianceHalves& halves) {
  std::vector<Rgb> mean;
  for (std::size_t k = 0; k < halves[0].size(); ++k) mean.push_back(0.5 * (halves[0][k] + halves[1][k]));
  return mean;
}

std::vector<Rgb> filtered(const IrradianceFilter& filter, const IrradianceHalves& halves) {
  return mean_of(filter.filter(halves, 0, halves[0].size(), 2));
}

/// Root mean square of the red channel.
double error(const std::vector<Rgb>& light, const std::function<double(int, int)>& truth) {
  double squares = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double d = light[at(x, y)].r - truth(x, y);
      squares += d * d;
    }
  return std::sqrt(squares / (kWidth * kHeight));
}

TEST(IrradianceFilter, OnAnEvenWallNoiseIsAveragedOut) {
  const auto even = [](int, int) { return 1.0; };
  const IrradianceHalves halves = measured(even, 0.3);
  const std::vector<Rgb> light = filtered(IrradianceFilter(kWidth, wall()), halves);
  // 49 pixels of a window would make it a seventh; that some look unlike each other costs some of it.
  EXPECT_LT(error(light, even), error(mean_of(halves), even) / 4);
  EXPECT_DOUBLE_EQ(light[0].g, 0.5 * light[0].r);
}

TEST(IrradianceFilter, AShadowsEdgeStays) {
  const auto shadow = [](int x, int) { return x < kWidth / 2 ? 1.0 : 0.25; };
  const IrradianceHalves halves = measured(shadow, 0.1);
  const std::vector<Rgb> light = filtered(IrradianceFilter(kWidth, wall()), halves);
  EXPECT_LT(error(light, shadow), error(mean_of(halves), shadow) / 3);
  for (int y = 0; y < kHeight; ++y) {
    EXPECT_NEAR(light[at(kWidth / 2 - 1, y)].r, 1, 0.1);
    EXPECT_NEAR(light[at(kWidth / 2, y)].r, 0.25, 0.1);
  }
}

TEST(IrradianceFilter, HalvesWithoutNoiseAreLeftAsTheyAre) {
  const auto slope = [](int x, int y) { return 1 + 0.02 * x + 0.01 * y; };
  const IrradianceHalves halves = measured(slope, 0);
  EXPECT_LT(error(filtered(IrradianceFilter(kWidth, wall()), halves), slope), 1e-12);
}

TEST(IrradianceFilter, ASpikeOfOneHalfDoesNotChooseItself) {
  IrradianceHalves halves = measured([](int, int) { return 1.0; }, 0.01);
  halves[0][at(20, 20)] *= 10;
  const std::vector<Rgb> light = filtered(IrradianceFilter(kWidth, wall()), halves);
  EXPECT_LT(light[at(20, 20)].r, 1.3);
}

/// Of two sides that meet in the middle of the picture, lit 1 and 1.05 with noise that hides the difference.
void expect_apart(const std::vector<SeenSurface>& seen) {
  const IrradianceFilter filter(kWidth, seen);
  const auto both = [](int x, int) { return x < kWidth / 2 ? 1.0 : 1.05; };
  const IrradianceHalves halves = measured(both, 0.3);
  IrradianceHalves other = halves;
  for (int y = 0; y < kHeight; ++y)
    for (int x = kWidth / 2; x < kWidth; ++x)
      for (std::vector<Rgb>& half : other) half[at(x, y)] *= 1.02;
  const std::vector<Rgb> light = filtered(filter, halves), changed = filtered(filter, other);
  // What a pixel is compared by reaches over one pixel of the other side, what it takes does not.
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth / 2 - 4; ++x) EXPECT_EQ(light[at(x, y)], changed[at(x, y)]) << x;
    double left = 0, right = 0;
    for (int k = 1; k <= 3; ++k) {
      left += light[at(kWidth / 2 - k, y)].r / 3;
      right += light[at(kWidth / 2 - 1 + k, y)].r / 3;
    }
    EXPECT_NEAR(left, 1, 0.1);
    EXPECT_NEAR(right, 1.05, 0.1);
  }
  // Over all rows little noise is left, and the step would be lost if the sides were mixed.
  double step = 0;
  for (int y = 0; y < kHeight; ++y)
    step += (light[at(kWidth / 2, y)].r - light[at(kWidth / 2 - 1, y)].r) / kHeight;
  EXPECT_NEAR(step, 0.05, 0.02);
}

TEST(IrradianceFilter, SidesThatMeetAtAnAngleAreApart) {
  std::vector<SeenSurface> seen = wall();
  for (int y = 0; y < kHeight; ++y)
    for (int x = kWidth / 2; x < kWidth; ++x)
      seen[at(x, y)] = {{0.01 * kWidth / 2, 0.01 * y, 0.01 * (x - kWidth / 2)}, {-1, 0, 0}, 0};
  expect_apart(seen);
}

TEST(IrradianceFilter, ParallelSidesBehindEachOtherAreApart) {
  std::vector<SeenSurface> seen = wall();
  for (int y = 0; y < kHeight; ++y)
    for (int x = kWidth / 2; x < kWidth; ++x) seen[at(x, y)].position.z = -0.5;
  expect_apart(seen);
}

TEST(IrradianceFilter, MaterialsAreApart) {
  std::vector<SeenSurface> seen = wall();
  for (int y = 0; y < kHeight; ++y)
    for (int x = kWidth / 2; x < kWidth; ++x) seen[at(x, y)].material = 1;
  expect_apart(seen);
}

TEST(IrradianceFilter, WhatStandsAloneKeepsItsOwn) {
  std::vector<SeenSurface> seen = wall();
  seen[at(7, 9)].material = 3;
  seen[at(20, 9)].material = SeenSurface::kNothing;
  IrradianceHalves halves = measured([](int, int) { return 1.0; }, 0.3);
  for (std::vector<Rgb>& half : halves) half[at(20, 9)] = Rgb(0);
  const std::vector<Rgb> light = filtered(IrradianceFilter(kWidth, seen), halves);
  EXPECT_EQ(light[at(7, 9)], mean_of(halves)[at(7, 9)]);
  EXPECT_EQ(light[at(20, 9)], Rgb(0));
}

TEST(IrradianceFilter, WhatHasNoNeighboursKeepsItsOwn) {
  const IrradianceHalves one{std::vector{Rgb(1, 2, 3)}, std::vector{Rgb(3, 2, 1)}};
  EXPECT_EQ(filtered(IrradianceFilter(1, {{{1, 2, 3}, {0, 0, 1}, 0}}), one), std::vector{Rgb(2)});
}

TEST(IrradianceFilter, PartsAreThoseOfTheWhole) {
  const IrradianceFilter filter(kWidth, wall());
  const IrradianceHalves halves = measured([](int x, int) { return 1 + 0.01 * x; }, 0.2);
  const IrradianceHalves whole = filter.filter(halves, 0, halves[0].size(), 1);
  IrradianceHalves parts;
  for (const auto& [from, to] :
       {std::pair<std::size_t, std::size_t>{0, 7}, {7, 7}, {7, 1000}, {1000, 1536}}) {
    const IrradianceHalves part = filter.filter(halves, from, to, 3);
    for (std::size_t half = 0; half < 2; ++half)
      parts[half].insert(parts[half].end(), part[half].begin(), part[half].end());
  }
  EXPECT_EQ(parts, whole);
}

}  // namespace
}  // namespace fluxel
