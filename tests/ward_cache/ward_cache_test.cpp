#include "tests/ward_cache/ward_cache.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fluxel::ward_cache {
namespace {

SidePoint on_floor(double x, double y) { return {{x, y, 0}, {0, 0, 1}, 0}; }

/// Of a record at the origin with slopes (0.5, 0, 0) and a radius of 2 m.
WardRecord sloping() {
  WardRecord record{on_floor(0, 0), Rgb(3), {}, {}, 2};
  record.translation.fill({0.5, 0, 0});
  record.rotation.fill({0, 0.25, 0});
  return record;
}

TEST(WardCache, ReachesWhereTheErrorIsAccepted) {
  WardCache cache(0.3);
  EXPECT_FALSE(cache.at(on_floor(0, 0)));
  cache.add(sloping());
  EXPECT_TRUE(cache.at(on_floor(0.59, 0)));  // 0.3 of 2 m
  EXPECT_FALSE(cache.at(on_floor(0.61, 0)));
  // sqrt(1 - cos(angle)) is 0.3 at 24.5 degrees.
  const auto turned = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return SidePoint{{0, 0, 0}, {std::sin(angle), 0, std::cos(angle)}, 1};
  };
  EXPECT_TRUE(cache.at(turned(24)));
  EXPECT_FALSE(cache.at(turned(25)));
  EXPECT_FALSE(cache.at({{0.1, 0, -0.1}, {0, 0, 1}, 1}));  // behind the record's plane
}

TEST(WardCache, FollowsGradients) {
  WardCache cache(0.9);
  cache.add(sloping());
  EXPECT_NEAR(cache.at(on_floor(1, 0.3))->g, 3.5, 1e-12);
  // Turned towards x by asin(0.1), about (0, 1, 0).
  EXPECT_NEAR(cache.at({{0, 0, 0}, {0.1, 0, std::sqrt(0.99)}, 1})->r, 3.025, 1e-12);
  WardRecord other = sloping();
  other.at = on_floor(1, 0);
  other.irradiance = Rgb(4);
  cache.add(other);
  // Halfway as much of both, which say 3.25 and 3.75.
  EXPECT_NEAR(cache.at(on_floor(0.5, 0))->b, 3.5, 1e-12);
}

TEST(WardCache, RadiiAreThoseOfNeighboursAndTheDistance) {
  WardCache cache(0.5);
  cache.add(sloping());
  WardRecord small = sloping();
  small.at = on_floor(1, 0);
  small.radius = 0.2;
  cache.add(small);
  // Of the first 1.2 m are left, of which half counts.
  EXPECT_TRUE(cache.at(on_floor(-0.59, 0)));
  EXPECT_FALSE(cache.at(on_floor(-0.61, 0)));
  WardRecord large = sloping();
  large.at = on_floor(1, 1);
  large.radius = 9;
  cache.add(large);
  EXPECT_TRUE(cache.at(on_floor(1, 1.59)));
  EXPECT_FALSE(cache.at(on_floor(1, 1.61)));
}

}  // namespace
}  // namespace fluxel::ward_cache
