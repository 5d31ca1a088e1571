#include "final_gather/record_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <set>
#include <vector>

#include "final_gather/error_diffusion.hpp"

namespace fluxel {
namespace {

TEST(DiffuseErrors, ChoosesAsManyAsAreAskedForEvenly) {
  constexpr int kWidth = 100, kHeight = 80;
  for (const float wanted : {0.0F, 0.03F, 0.25F, 1.0F}) {
    const std::vector<std::uint32_t> chosen =
        diffuse_errors(kWidth, std::vector<float>(std::size_t{kWidth} * kHeight, wanted));
    EXPECT_NEAR(static_cast<double>(chosen.size()), wanted * kWidth * kHeight, 0.02 * kWidth * kHeight);
    EXPECT_TRUE(std::ranges::is_sorted(chosen));
    // In each block of 20 x 20 about as many; the first rows begin without what others hand on.
    std::array<int, 20> in_block{};
    for (const std::uint32_t pixel : chosen) ++in_block[pixel % kWidth / 20 + 5 * (pixel / kWidth / 20)];
    for (const int count : in_block) EXPECT_NEAR(count, wanted * 400, 0.1 * wanted * 400 + 6);
  }
}

constexpr int kWidth = 192, kHeight = 128;

/// A wall of 1 cm a pixel on the left; on the right a floor seen at a glance, 1 cm wide and 8 cm long a
/// pixel.
std::vector<SidePoint> wall_and_floor() {
  std::vector<SidePoint> seen;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      seen.push_back(x < kWidth / 2 ? SidePoint{{0.01 * x, 0, 0.01 * y}, {0, -1, 0}, 0}
                                    : SidePoint{{0.01 * x, 0.08 * y, 5}, {0, 0, 1}, 1});
  for (int x = 0; x < 20; ++x) seen[static_cast<std::size_t>(x)].piece = SidePoint::kNothing;
  return seen;
}

/// Of those on one surface, the least.
double least_distance(const std::vector<SidePoint>& seen, const std::vector<std::uint32_t>& chosen,
                      std::uint32_t piece) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t a : chosen)
    for (const std::uint32_t b : chosen)
      if (a < b && seen[a].piece == piece && seen[b].piece == piece)
        least = std::min(least, glm::distance(seen[a].position, seen[b].position));
  return least;
}

TEST(RecordPlaces, AreApartInTheScene) {
  const std::vector<SidePoint> seen = wall_and_floor();
  RecordPlaces places(kWidth, seen);
  const std::vector<std::uint32_t> first = places.first();
  EXPECT_GT(first.size(), 400U);
  EXPECT_LT(first.size(), 2500U);
  for (const std::uint32_t pixel : first) EXPECT_NE(seen[pixel].piece, SidePoint::kNothing);
  EXPECT_GT(least_distance(seen, first, 0), 0.025);  // of 4 pixels
  EXPECT_GT(least_distance(seen, first, 1), 0.07);
  // No place is far from all of them.
  for (std::size_t pixel = 0; pixel < seen.size(); ++pixel) {
    if (seen[pixel].piece == SidePoint::kNothing) continue;
    const double allowed = seen[pixel].piece == 0 ? 0.12 : 0.4;
    EXPECT_TRUE(std::ranges::any_of(first, [&](std::uint32_t other) {
      return seen[other].piece == seen[pixel].piece &&
             glm::distance(seen[other].position, seen[pixel].position) < allowed;
    })) << pixel;
  }
}

TEST(RecordPlaces, ComeWhereErrorsAreLarge) {
  const std::vector<SidePoint> seen = wall_and_floor();
  RecordPlaces places(kWidth, seen);
  const std::vector<std::uint32_t> first = places.first();
  EXPECT_TRUE(places.more({}).empty());
  std::vector<PixelError> errors;
  for (std::uint32_t pixel = 0; pixel < seen.size(); ++pixel) {
    const bool is_large = pixel % kWidth < 40 && pixel / kWidth > 60;
    errors.push_back({pixel, is_large ? 4.0F : 0.9F, 0.08F});
  }
  const std::vector<std::uint32_t> more = places.more(errors);
  EXPECT_GT(more.size(), 100U);
  const std::set<std::uint32_t> before(first.begin(), first.end());
  for (const std::uint32_t pixel : more) {
    EXPECT_TRUE(pixel % kWidth < 40 && pixel / kWidth > 60);
    EXPECT_FALSE(before.contains(pixel));
  }
  // Where no record reaches as densely as at first.
  const std::vector<PixelError> alone{{5 * kWidth + 5, std::numeric_limits<float>::infinity(), 0}};
  EXPECT_LE(places.more(alone).size(), 1U);
}

}  // namespace
}  // namespace fluxel
