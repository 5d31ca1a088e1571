#include "metrics/glare_rating.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fluxel {
namespace {

TEST(GlareRating, PositionIndexIsThatOfTheTable) {
  // CIE 117:1995, table 4.1: T/R (sideways) and H/R (up) over the distance ahead.
  struct Place {
    double aside, up, index;
  };
  for (const auto& [aside, up, index] : {Place{0, 0, 1.00}, {0, 0.5, 2.86}, {0, 1, 7.00}}) {
    const double sigma = std::atan(std::hypot(aside, up)), tau = std::atan2(aside, up);
    if (up == 0 && aside == 0)
      EXPECT_EQ(position_index(0, 0), 1);
    else
      EXPECT_NEAR(position_index(sigma, tau), index, 0.06 * index) << aside << ' ' << up;
  }
}

TEST(GlareRating, PositionsAsideCountLess) {
  // Of Levin's formula, worked out apart from the code: T/R, H/R, index.
  struct Place {
    double aside, up, index;
  };
  for (const auto& [aside, up, index] :
       {Place{0.5, 0.5, 2.92}, {1, 0, 2.05}, {1, 0.5, 3.76}, {2, 1, 8.30}, {3, 1.9, 15.06}})
    EXPECT_NEAR(position_index(std::atan(std::hypot(aside, up)), std::atan2(aside, up)), index, 0.005 * index)
        << aside << ' ' << up;
}

TEST(GlareRating, IsWorkedByHand) {
  // Two sources of 10,000 cd/m2 and 0.01 sr with p = 2 before 40 cd/m2: 8 lg(0.25 / 40 * 2 * 1e8 * 0.01 / 4).
  GlareSources sources;
  sources.weighted = 2 * 1e8 * 0.01 / 4;
  const auto rating = glare_rating(sources, 40, 2);
  ASSERT_TRUE(rating);
  EXPECT_NEAR(rating->UGR, 27.96, 0.01);
  EXPECT_NEAR(rating->error, std::hypot(8 / std::log(10.0) * 0.05, 0.4), 1e-12);
}

TEST(GlareRating, ThereIsNoneWithoutSourcesOrBackground) {
  EXPECT_FALSE(glare_rating({}, 40, 1));
  GlareSources sources;
  sources.weighted = 1e6;
  EXPECT_FALSE(glare_rating(sources, 0.5, 1)) << "darker than its error";
  EXPECT_FALSE(glare_rating(sources, -2, 1));
}

}  // namespace
}  // namespace fluxel
