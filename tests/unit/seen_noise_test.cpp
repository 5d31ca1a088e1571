#include "image/seen_noise.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace fluxel {
namespace {

constexpr int kWidth = 60, kHeight = 40;

Raster wall() {
  Raster raster;
  raster.width = kWidth;
  raster.height = kHeight;
  raster.patch.assign(kWidth * kHeight, PatchId{3});
  raster.front.assign(kWidth * kHeight, 1);
  return raster;
}

std::vector<Rgb> light(const std::function<double(int, int)>& of) {
  std::vector<Rgb> irradiance;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) irradiance.push_back(of(x, y) * Rgb(1, 0.5, 0.2));
  return irradiance;
}

TEST(SeenNoise, IsThatOfAPixel) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  EXPECT_NEAR(*seen_noise(wall(), 1, light([&](int, int) { return 7 * (1 + 0.02 * normal(random)); })), 0.02,
              0.001);
}

TEST(SeenNoise, GradientsAndShadowsAreNone) {
  EXPECT_NEAR(*seen_noise(wall(), 1, light([](int x, int y) { return 1 + 0.1 * x + 0.02 * y; })), 0, 1e-12);
  EXPECT_NEAR(*seen_noise(wall(), 1, light([](int x, int y) { return x + y < 50 ? 1.0 : 0.2; })), 0, 1e-12);
}

TEST(SeenNoise, IsThatOfMeansWherePixelsHaveSeveralRays) {
  // The mean of four has half the noise of each.
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  EXPECT_NEAR(*seen_noise(wall(), 2, light([&](int, int) { return 7 * (1 + 0.02 * normal(random)); })), 0.01,
              0.001);
  // A pixel in which two surfaces meet is none of either.
  Raster raster = wall();
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel)
    raster.patch[pixel] = PatchId{static_cast<std::uint32_t>((pixel % kWidth + 1) / 2 % 2)};
  EXPECT_FALSE(seen_noise(raster, 2, light([](int, int) { return 1.0; })));
}

TEST(SeenNoise, SurfacesAreApart) {
  Raster raster = wall();
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel) {
    raster.patch[pixel] = PatchId{static_cast<std::uint32_t>(pixel % 4 / 2)};
    raster.front[pixel] = pixel / kWidth % 4 < 2 ? 1 : 0;
  }
  EXPECT_FALSE(seen_noise(raster, 1, light([](int x, int) { return x + 1.0; })));
  raster.patch.assign(raster.pixels(), kNoPatch);
  EXPECT_FALSE(seen_noise(raster, 1, light([](int, int) { return 1.0; })));
  EXPECT_FALSE(seen_noise(wall(), 1, light([](int, int) { return 0.0; })));
}

}  // namespace
}  // namespace fluxel
