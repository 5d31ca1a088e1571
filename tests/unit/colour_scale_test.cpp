#include "image/colour_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fluxel {
namespace {

TEST(ColourScale, EndsAtTheLargestValue) {
  const std::vector<double> values{3, 740, std::numeric_limits<double>::quiet_NaN(), 12};
  const ColourScale scale = choose_scale(values, {});
  EXPECT_EQ(scale.min, 0);
  EXPECT_EQ(scale.max, 740);
  EXPECT_FALSE(scale.logarithmic);
  EXPECT_DOUBLE_EQ(scale.place(370), 0.5);
  EXPECT_EQ(scale.place(-1), 0);
  EXPECT_EQ(scale.place(1e9), 1);
  const std::vector<double> hundreds{0, 100, 200, 300, 400, 500, 600, 700};
  EXPECT_EQ(scale.marks(), hundreds);
}

TEST(ColourScale, DecadesAreEven) {
  const std::vector<double> values{1};
  const ColourScale scale = choose_scale(values, {1000, 2});
  EXPECT_DOUBLE_EQ(scale.min, 10);
  EXPECT_NEAR(scale.place(100), 0.5, 1e-12);
  EXPECT_EQ(scale.place(0), 0);
  const std::vector<double> marks = scale.marks();
  ASSERT_EQ(marks.size(), 7u);
  EXPECT_NEAR(marks[0], 10, 1e-9);
  EXPECT_NEAR(marks[2], 50, 1e-9);
  EXPECT_NEAR(marks[6], 1000, 1e-6);
}

TEST(ColourScale, WhatRoundsToNothingHasNoMarks) {
  EXPECT_TRUE((ColourScale{0, 1e-320, true}.marks().empty()));
}

TEST(ColourScale, AnEndThatIsAskedForStays) {
  const std::vector<double> warm{300, 310};
  EXPECT_EQ(choose_scale(warm, {200, {}}, ScaleStart::least).max, 200);
}

TEST(ColourScale, DarknessHasAScale) {
  const std::vector<double> dark{0, 0};
  const ColourScale scale = choose_scale(dark, {});
  EXPECT_EQ(scale.max, 1);
  EXPECT_EQ(scale.place(0), 0);
}

TEST(ColourScale, MayBeginAtTheLeastValue) {
  const std::vector<double> values{-20, 293, 310};
  const ColourScale scale = choose_scale(values, {}, ScaleStart::least);
  EXPECT_EQ(scale.min, -20);
  EXPECT_EQ(scale.max, 310);
  const std::vector<double> same{300, 300};
  EXPECT_LT(choose_scale(same, {}, ScaleStart::least).min, choose_scale(same, {}, ScaleStart::least).max);
}

TEST(ColourScale, ColoursBecomeBrighter) {
  double before = -1;
  for (int k = 0; k <= 20; ++k) {
    const auto [r, g, b] = scale_colour(k / 20.0);
    const double luminance = 0.2126 * std::pow(r / 255.0, 2.2) + 0.7152 * std::pow(g / 255.0, 2.2) +
                             0.0722 * std::pow(b / 255.0, 2.2);
    EXPECT_GT(luminance, before) << k;
    before = luminance;
  }
}

TEST(RoundValues, AreWithinTheirEnds) {
  const std::vector<double> quarters{0, 0.5, 1, 1.5};
  EXPECT_EQ(round_values(0, 1.7, 4), quarters);
  EXPECT_FALSE(std::signbit(round_values(0, 7, 8).front())) << "-0 would be written so";
  EXPECT_TRUE(round_values(1, 1, 4).empty());
}

}  // namespace
}  // namespace fluxel
