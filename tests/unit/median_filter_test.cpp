#include "image/median_filter.hpp"

#include <gtest/gtest.h>

namespace fluxel {
namespace {

Picture black_picture(int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.radiance.assign(picture.pixels(), Rgb(0.0));
  return picture;
}

TEST(MedianFilter, RadiusZeroLeavesThePicture) {
  Picture picture = black_picture(3, 1);
  picture.radiance = {Rgb(1), Rgb(5), Rgb(2)};
  const auto before = picture.radiance;
  apply_median(0, picture);
  EXPECT_EQ(picture.radiance, before);
}

TEST(MedianFilter, RemovesAPointKeepsAnEdgeAndWorksOnEachChannel) {
  Picture picture = black_picture(6, 5);
  for (std::size_t i = 0; i < picture.pixels(); ++i) picture.radiance[i] = Rgb(i % 6 < 3 ? 1 : 2);
  const auto clean = picture.radiance;
  picture.radiance[2 * 6 + 1].g = 1000;
  picture.radiance[0].b = 1000;  // a corner
  apply_median(1, picture);
  // In the corner the repeated pixel fills four of nine places, fewer than half.
  EXPECT_EQ(picture.radiance, clean);
}

TEST(MedianFilter, WindowHasTheRadiusInEachDirection) {
  Picture picture = black_picture(9, 9);
  for (int y = 2; y <= 6; ++y) {
    for (int x = 2; x <= 6; ++x) picture.radiance[static_cast<std::size_t>(y * 9 + x)] = Rgb(1);
  }
  apply_median(2, picture);
  // At (2, 4) 15 of 25 pixels are 1; at (2, 2) 9, at (3, 3) 16, at (1, 4) 10.
  EXPECT_EQ(picture.radiance[4 * 9 + 2].r, 1);
  EXPECT_EQ(picture.radiance[2 * 9 + 2].r, 0);
  EXPECT_EQ(picture.radiance[3 * 9 + 3].r, 1);
  EXPECT_EQ(picture.radiance[4 * 9 + 1].r, 0);
}

}  // namespace
}  // namespace fluxel
