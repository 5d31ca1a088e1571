#include "image/tone_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.hpp"

namespace fluxel {
namespace {

/// A row of these radiances, all of it reflected by a white surface.
Picture row_of(const std::vector<Rgb>& radiance) {
  Picture picture;
  picture.width = static_cast<int>(radiance.size());
  picture.height = 1;
  picture.radiance = radiance;
  for (const Rgb& L : radiance) {
    picture.reflectance.push_back(Rgb(1));
    picture.irradiance.push_back(L * std::numbers::pi);
  }
  return picture;
}

TEST(ToneMap, EncodesSrgbWithRounding) {
  // Linear values at 8-bit codes by the decoding formula of IEC 61966-2-1; 0.0031308 is where its branches
  // meet.
  const Picture picture = row_of({Rgb(0, 0.0031308, 1), Rgb(0.2140411, 0.5, 0.18)});
  const DisplayPicture display = tone_map(picture, 0.0, Tone::linear);
  const std::vector<std::uint8_t> expected = {0, 10, 255, 127, 188, 118};
  EXPECT_EQ(display.rgb[0], expected[0]);
  EXPECT_EQ(display.rgb[1], expected[1]);
  EXPECT_EQ(display.rgb[2], expected[2]);
  EXPECT_EQ(display.rgb[4], expected[4]);
  EXPECT_EQ(display.rgb[5], expected[5]);
  EXPECT_EQ(display.curve.exposure, 0.0);
}

TEST(ToneMap, EveryCodeSurvivesDecodingAndEncoding) {
  std::vector<Rgb> linear;
  for (int code = 0; code < 256; ++code) {
    const double encoded = code / 255.0;
    linear.emplace_back(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
  const DisplayPicture display = tone_map(row_of(linear), 0.0, Tone::linear);
  for (std::size_t code = 0; code < 256; ++code) EXPECT_EQ(display.rgb[3 * code + 1], code);
}

TEST(ToneMap, ExposureIsInStops) {
  const DisplayPicture brighter = tone_map(row_of({Rgb(0.125)}), 2.0, Tone::linear);
  EXPECT_EQ(brighter.rgb, (std::vector<std::uint8_t>{188, 188, 188}));  // linear 0.5
  EXPECT_EQ(brighter.curve.exposure, 2.0);
  EXPECT_EQ(tone_map(row_of({Rgb(2)}), -2.0, Tone::linear).rgb[0], 188);
}

TEST(ToneMap, ChoosesThe98thPercentileOfWhatReflects) {
  std::vector<Rgb> radiance;
  for (int i = 1; i <= 101; ++i) radiance.emplace_back(i <= 99 ? 0.02 * i : 1000.0);
  for (int i = 0; i < 500; ++i) radiance.emplace_back(0.0);  // dark and background pixels do not count
  const DisplayPicture display = tone_map(row_of(radiance), std::nullopt, Tone::linear);
  EXPECT_NEAR(display.curve.exposure, std::log2(0.8 / (0.02 * 99)), 1e-12);  // the 99th of 101
  EXPECT_EQ(display.rgb[3 * 98], 231);                                       // linear 0.8
  EXPECT_EQ(display.rgb[3 * 100], 255);
}

TEST(ToneMap, ALuminaireDoesNotDarkenTheRest) {
  Picture picture = row_of(std::vector<Rgb>(20, Rgb(0.1)));
  const double without = tone_map(picture, std::nullopt, Tone::linear).curve.exposure;
  for (std::size_t i = 0; i < 10; ++i) picture.radiance[i] = Rgb(1000);
  EXPECT_NEAR(tone_map(picture, std::nullopt, Tone::linear).curve.exposure, without, 1e-12);
  EXPECT_NEAR(without, 3, 1e-12);  // 0.1 * 2^3 = 0.8
}

TEST(ToneMap, WeighsTheChannelsByLuminance) {
  EXPECT_NEAR(tone_map(row_of({Rgb(0, 1, 0)}), std::nullopt, Tone::linear).curve.exposure,
              std::log2(0.8 / 0.7152), 1e-12);
}

TEST(ToneMap, WhereNothingReflectsTheEmittersSetTheExposure) {
  Picture picture = row_of({Rgb(4), Rgb(0)});
  picture.reflectance.assign(2, Rgb(0.0));
  EXPECT_NEAR(tone_map(picture, std::nullopt, Tone::linear).curve.exposure, std::log2(0.2), 1e-12);
}

/// Decoded again, to linear values.
Rgb linear(const DisplayPicture& display, std::size_t pixel) {
  Rgb colour;
  for (int c = 0; c < kChannels; ++c) {
    const double encoded = display.rgb[3 * pixel + static_cast<std::size_t>(c)] / 255.0;
    colour[c] = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
  }
  return colour;
}

TEST(ToneMap, HueAndSaturationStay) {
  for (const Tone tone : {Tone::linear, Tone::filmic, Tone::reinhard})
    for (const double times : {0.3, 1.0, 4.0, 1e3, 1e200}) {
      const Rgb shown = linear(tone_map(row_of({times * Rgb(1, 0.3, 0.1), Rgb(0.2)}), 0.0, tone), 0);
      EXPECT_NEAR(shown.g / shown.r, 0.3, 0.02) << times;
      EXPECT_NEAR(shown.b / shown.r, 0.1, 0.02) << times;
    }
}

TEST(ToneMap, CurvesRiseFromBlackToWhite) {
  for (const Tone tone : {Tone::filmic, Tone::reinhard}) {
    std::vector<Rgb> radiance;
    for (int k = 0; k <= 400; ++k) radiance.emplace_back(0.02 * k);
    const DisplayPicture display = tone_map(row_of(radiance), 0.0, tone);
    EXPECT_EQ(display.rgb[0], 0);
    for (std::size_t k = 1; k < radiance.size(); ++k) EXPECT_GE(display.rgb[3 * k], display.rgb[3 * k - 3]);
    EXPECT_GT(display.rgb[3 * 50], 3 * display.rgb[3]);
    EXPECT_LT(display.rgb[3 * 50], 235);  // 1, below what is white
    EXPECT_EQ(display.rgb.back(), 255);
  }
}

TEST(ToneMap, ReinhardIsTheEquation) {
  // W = 2: 1 becomes (1 + 1/4) / 2 = 0.625, and 2 becomes 1.
  const DisplayPicture display = tone_map(row_of({Rgb(1), Rgb(2), Rgb(0.5)}), 0.0, Tone::reinhard);
  EXPECT_NEAR(linear(display, 0).g, 0.625, 0.004);
  EXPECT_EQ(display.rgb[3], 255);
  EXPECT_NEAR(linear(display, 2).g, 0.5 * 1.125 / 1.5, 0.004);
}

TEST(ToneMap, WhatIsNearlyBlackDoesNotWashOutTheRest) {
  const double without = tone_map(row_of({Rgb(1), Rgb(2)}), std::nullopt, Tone::reinhard).curve.exposure;
  const Picture picture = row_of({Rgb(1), Rgb(2), Rgb(1e-6), Rgb(1e-9), Rgb(1e-3)});
  EXPECT_NEAR(tone_map(picture, std::nullopt, Tone::reinhard).curve.exposure, without, 1e-12);
}

TEST(ToneMap, CurvesShowTheLogarithmicMeanAsMiddleGrey) {
  for (const Tone tone : {Tone::filmic, Tone::reinhard}) {
    Picture picture = row_of({Rgb(1), Rgb(4), Rgb(16), Rgb(4)});
    EXPECT_NEAR(tone_map(picture, std::nullopt, tone).curve.exposure, std::log2(0.18 / 4), 1e-12);
    picture.radiance[3] = Rgb(1e6);  // a lamp
    picture.reflectance[3] = Rgb(0);
    EXPECT_NEAR(tone_map(picture, std::nullopt, tone).curve.exposure, std::log2(0.18 / 4), 1e-12);
    EXPECT_EQ(tone_map(picture, std::nullopt, tone).rgb[9], 255);
  }
}

TEST(ToneMap, BlackAndBrokenPicturesGiveAFiniteExposure) {
  const DisplayPicture black = tone_map(row_of({Rgb(0), Rgb(0)}), std::nullopt, Tone::linear);
  EXPECT_EQ(black.curve.exposure, 0);
  EXPECT_EQ(black.rgb, std::vector<std::uint8_t>(6, 0));
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(tone_map(row_of({Rgb(infinite), Rgb(std::nan(""))}), std::nullopt, Tone::linear).curve.exposure,
            0);
}

TEST(ToneMap, RefusesAnExposureThatIsNotFinite) {
  EXPECT_THROW((void)tone_map(row_of({Rgb(1)}), std::nan(""), Tone::linear), InputError);
}

}  // namespace
}  // namespace fluxel
