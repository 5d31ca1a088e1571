#include "image/value_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

namespace fluxel {
namespace {

std::map<std::array<std::uint8_t, 3>, std::size_t> pixels_by_colour(const DisplayPicture& picture) {
  std::map<std::array<std::uint8_t, 3>, std::size_t> counts;
  for (std::size_t k = 0; k < picture.rgb.size(); k += 3)
    ++counts[{picture.rgb[k], picture.rgb[k + 1], picture.rgb[k + 2]}];
  return counts;
}

TEST(ValueMap, CellsHaveTheColoursOfTheirValues) {
  ValueMap map{2, 1, {25, 100}, "desk", "lx", {"mean 62.5 lx"}, {2, 1}};
  const ColourScale scale{0, 100, false};
  const DisplayPicture picture = draw_value_map(map, scale);
  ASSERT_EQ(picture.rgb.size(),
            3u * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  auto counts = pixels_by_colour(picture);
  // 720 x 360 pixels, of which text, frame and isolines take some.
  for (const double value : map.values) {
    EXPECT_GT(counts[scale_colour(scale.place(value))], 360u * 360u * 9 / 10) << value;
    EXPECT_LT(counts[scale_colour(scale.place(value))], 361u * 362u) << value;
  }
  EXPECT_GT(counts.size(), 150u) << "the legend has all colours";
}

TEST(ValueMap, TheFirstRowIsOnTop) {
  const ColourScale scale{0, 1, false};
  const DisplayPicture picture = draw_value_map({1, 2, {0, 1}, "", "lx", {}, {1, 1}}, scale);
  const auto first_of = [&](double place) {
    const auto colour = scale_colour(place);
    for (std::size_t k = 0; k < picture.rgb.size(); k += 3)
      if (std::equal(colour.begin(), colour.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(k)) &&
          k / 3 % static_cast<std::size_t>(picture.width) < 500)  // left of the legend
        return k;
    return picture.rgb.size();
  };
  EXPECT_LT(first_of(0), first_of(1));
}

TEST(ValueMap, WhatWasNotMeasuredIsGrey) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const DisplayPicture picture = draw_value_map({2, 1, {none, 1}, "", "lx", {}, {2, 1}}, {0, 1, false});
  EXPECT_GT((pixels_by_colour(picture)[{0xe0, 0xe0, 0xe0}]), 360u * 350u);
}

TEST(ValueMap, ManyCellsAreDrawnByTheirMeans) {
  std::vector<double> values(40'000);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = k % 2 == 0 ? 0 : 1;
  const DisplayPicture picture = draw_value_map({40'000, 1, values, "", "lx", {}, {4, 1}}, {0, 1, false});
  EXPECT_LT(std::max(picture.width, picture.height), 2000);
  EXPECT_GT(pixels_by_colour(picture)[scale_colour(0.4)] + pixels_by_colour(picture)[scale_colour(0.6)],
            10'000u);
}

TEST(ValueMap, ThinPicturesAreNotMagnifiedWithoutEnd) {
  const DisplayPicture picture =
      draw_value_map({400, 2, std::vector<double>(800, 1), "", "", {}, {}}, {0, 1, false});
  EXPECT_LT(picture.width, 5000);
}

TEST(ValueMap, NarrowMapsHaveRoomForTheirText) {
  const std::string line(100, 'm');
  const DisplayPicture picture =
      draw_value_map({1, 4, {1, 1, 1, 1}, "", "lx", {line}, {0.1, 4}}, {0, 1, false});
  EXPECT_GT(picture.width, 800);
}

TEST(ValueMap, PicturesKeepTheirPixels) {
  ValueMap map{400, 380, std::vector<double>(400 * 380, 0.5), "room", "cd/m2", {}, {}};
  const DisplayPicture picture = draw_value_map(map, {0, 1, false});
  EXPECT_NEAR(static_cast<double>(pixels_by_colour(picture)[scale_colour(0.5)]), 400 * 380, 2000);
}

}  // namespace
}  // namespace fluxel
