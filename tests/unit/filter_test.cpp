#include "image/filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace fluxel {
namespace {

using Kind = PictureFilter::Kind;

Picture black_picture(int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.radiance.assign(picture.pixels(), Rgb(0.0));
  return picture;
}

TEST(Filter, NoneAndSizeZeroLeaveThePicture) {
  Picture picture = black_picture(3, 1);
  picture.radiance = {Rgb(1), Rgb(5), Rgb(2)};
  const auto before = picture.radiance;
  apply_filter({Kind::none, 4}, picture);
  apply_filter({Kind::gaussian, 0}, picture);
  apply_filter({Kind::median, 0}, picture);
  EXPECT_EQ(picture.radiance, before);
}

TEST(Filter, GaussianSpreadsAPointAsTheProductOfTwoGaussians) {
  const double sigma = 1.2;  // cut at 3.6: three pixels to each side, and no border in reach
  Picture picture = black_picture(13, 13);
  picture.radiance[6 * 13 + 6] = Rgb(1, 2, 4);
  apply_filter({Kind::gaussian, sigma}, picture);
  double norm = 0;
  for (int offset = -3; offset <= 3; ++offset) norm += std::exp(-offset * offset / (2 * sigma * sigma));
  for (int y = 0; y < 13; ++y) {
    for (int x = 0; x < 13; ++x) {
      const int dx = x - 6, dy = y - 6;
      const bool inside = std::abs(dx) <= 3 && std::abs(dy) <= 3;
      const double expected =
          inside ? std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma)) / (norm * norm) : 0.0;
      const Rgb& value = picture.radiance[static_cast<std::size_t>(y * 13 + x)];
      EXPECT_NEAR(value.r, expected, 1e-14);
      EXPECT_NEAR(value.b, 4 * expected, 1e-14);
    }
  }
}

TEST(Filter, GaussianKeepsAConstantUpToTheBorders) {
  for (const double sigma : {0.2, 1.0, 50.0}) {
    Picture picture = black_picture(7, 3);
    picture.radiance.assign(picture.pixels(), Rgb(3, 0.5, 7));
    apply_filter({Kind::gaussian, sigma}, picture);
    for (const Rgb& value : picture.radiance) {
      EXPECT_NEAR(value.r, 3, 1e-13);
      EXPECT_NEAR(value.g, 0.5, 1e-13);
      EXPECT_NEAR(value.b, 7, 1e-13);
    }
  }
}

TEST(Filter, MedianRemovesAPointKeepsAnEdgeAndWorksOnEachChannel) {
  Picture picture = black_picture(6, 5);
  for (std::size_t i = 0; i < picture.pixels(); ++i) picture.radiance[i] = Rgb(i % 6 < 3 ? 1 : 2);
  const auto clean = picture.radiance;
  picture.radiance[2 * 6 + 1].g = 1000;
  picture.radiance[0].b = 1000;  // a corner
  apply_filter({Kind::median, 1}, picture);
  // In the corner the repeated pixel fills four of nine places, fewer than half.
  EXPECT_EQ(picture.radiance, clean);
}

TEST(Filter, MedianWindowHasTheRadiusInEachDirection) {
  Picture picture = black_picture(9, 9);
  for (int y = 2; y <= 6; ++y) {
    for (int x = 2; x <= 6; ++x) picture.radiance[static_cast<std::size_t>(y * 9 + x)] = Rgb(1);
  }
  apply_filter({Kind::median, 2}, picture);
  // At (2, 4) 15 of 25 pixels are 1; at (2, 2) 9, at (3, 3) 16, at (1, 4) 10.
  EXPECT_EQ(picture.radiance[4 * 9 + 2].r, 1);
  EXPECT_EQ(picture.radiance[2 * 9 + 2].r, 0);
  EXPECT_EQ(picture.radiance[3 * 9 + 3].r, 1);
  EXPECT_EQ(picture.radiance[4 * 9 + 1].r, 0);
}

TEST(Filter, RefusesImpossibleSizes) {
  Picture picture = black_picture(2, 2);
  EXPECT_THROW(apply_filter({Kind::gaussian, -1}, picture), InputError);
  EXPECT_THROW(apply_filter({Kind::gaussian, std::numeric_limits<double>::quiet_NaN()}, picture), InputError);
  EXPECT_THROW(apply_filter({Kind::median, 1.5}, picture), InputError);
}

}  // namespace
}  // namespace fluxel
