#include "scene/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel {
namespace {

const glm::dvec3 kUp{0, 0, 1};
const Polygon kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

Polygon regular(int n) {
  Polygon polygon;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    polygon.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  return polygon;
}

double total_area(const std::vector<Outline<glm::dvec3>>& outlines) {
  double sum = 0;
  for (const auto& outline : outlines) sum += area(corners(outline));
  return sum;
}

TEST(Polygon, AreaCentroidAndWidth) {
  const Polygon triangle{{0, 0, 2}, {3, 0, 2}, {0, 4, 2}};
  EXPECT_DOUBLE_EQ(area(triangle), 6);
  EXPECT_DOUBLE_EQ(area_vector(triangle).z, 6);
  EXPECT_NEAR(glm::distance(centroid(triangle), {1, 4.0 / 3, 2}), 0, 1e-15);
  EXPECT_NEAR(width(triangle, kUp), 2.4, 1e-15);  // 2 A over the longest edge, 5
}

TEST(Polygon, DistanceFromPointsOfSpace) {
  EXPECT_DOUBLE_EQ(squared_distance({0.3, 0.9, -2}, kSquare, kUp), 4) << "below it";
  EXPECT_DOUBLE_EQ(squared_distance({0.5, -3, 4}, kSquare, kUp), 25) << "from an edge";
  EXPECT_DOUBLE_EQ(squared_distance({2, 3, 2}, kSquare, kUp), 1 + 4 + 4) << "from a corner";
  EXPECT_EQ(squared_distance({1, 0.2, 0}, kSquare, kUp), 0) << "on an edge";
  const Polygon with_a_point_twice{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_DOUBLE_EQ(squared_distance({3, 0, 0}, with_a_point_twice, kUp), 4);
}

TEST(Polygon, CentroidOfATrapezoidIsOfItsArea) {
  const Polygon trapezoid{{0, 0, 0}, {3, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_NEAR(centroid(trapezoid).y, (3 + 2 * 1) / (3.0 * (3 + 1)), 1e-15);  // h (a + 2b) / (3 (a + b))
}

TEST(Polygon, SplitSharesTheCutAndKeepsTheArea) {
  const Halves halves = split(kSquare, {{0.25, 0, 0}, {1, 0, 0}}, 1e-9);
  EXPECT_DOUBLE_EQ(area(halves.front), 0.75);
  EXPECT_DOUBLE_EQ(area(halves.back), 0.25);
}

TEST(Polygon, SplitLeavesWhatIsThinnerThanTheTolerance) {
  const Halves halves = split(kSquare, {{1e-7, 0, 0}, {1, 0, 0}}, 1e-6);
  EXPECT_EQ(halves.front, kSquare);
  EXPECT_TRUE(halves.back.empty());
}

TEST(Polygon, SplitThroughCornersMakesNoOthers) {
  const glm::dvec3 diagonal = glm::normalize(glm::dvec3{1, -1, 0});
  const Halves halves = split(kSquare, {{0, 0, 0}, diagonal}, 1e-9);
  EXPECT_EQ(halves.front.size(), 3u);
  EXPECT_EQ(halves.back.size(), 3u);
  EXPECT_DOUBLE_EQ(area(halves.front) + area(halves.back), 1);
}

TEST(Polygon, SplitBesideTwoCornersWithinTheToleranceDoesNotDoubleArea) {
  const Polygon polygon{{-1, 0, 0}, {-4e-4, -1, 0}, {4e-4, -1, 0}, {1, 0, 0}, {0, 1, 0}};
  const Halves halves = split(polygon, {{0, 0, 0}, {1, 0, 0}}, 1e-3);
  EXPECT_NEAR(area(halves.front) + area(halves.back), area(polygon), 1e-15);
}

TEST(Polygon, ClipKeepsWhatIsDeepInside) {
  const auto inside = clip({{-1, 0.5, 0}, {2, 0.5, 0}}, kSquare, kUp, 0.1);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside->from.x, 0.1, 1e-15);
  EXPECT_NEAR(inside->to.x, 0.9, 1e-15);
  EXPECT_FALSE(clip({{0, 0, 0}, {1, 0, 0}}, kSquare, kUp, 1e-9));  // along an edge
  EXPECT_FALSE(clip({{2, 0.5, 0}, {3, 0.5, 0}}, kSquare, kUp, 0));
}

TEST(Polygon, NeighboursShareNoArea) {
  const Polygon beside{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  const Polygon over{{0.9, 0, 0}, {1.9, 0, 0}, {1.9, 1, 0}, {0.9, 1, 0}};
  EXPECT_FALSE(share_area(kSquare, beside, kUp, kUp, 1e-6));
  EXPECT_TRUE(share_area(kSquare, over, kUp, kUp, 1e-6));
  // Tip to tip: each edge of one has the other's tip 0.05 inside, and no edge parts them.
  const Polygon left{{0, 0, 0}, {1, 0.5, 0}, {0, 1, 0}}, right{{0.95, 0.5, 0}, {2, 0, 0}, {2, 1, 0}};
  EXPECT_TRUE(share_area(left, right, kUp, kUp, 1e-3));
  EXPECT_FALSE(share_area(left, right, kUp, kUp, 0.05));
  // No edge has less than 0.22 of the other triangle inside, and yet what they share is 0.0104 wide.
  const Polygon needle{{0.175, 0.067, 0}, {0.376, 0.015, 0}, {0.054, 0.674, 0}};
  const Polygon thin{{0.873, 0.982, 0}, {0.001, 0.265, 0}, {0.971, 0.992, 0}};
  EXPECT_TRUE(share_area(needle, thin, kUp, kUp, 0.005));
  EXPECT_FALSE(share_area(needle, thin, kUp, kUp, 0.02));
  EXPECT_FALSE(share_area(thin, needle, kUp, kUp, 0.02));
}

TEST(Polygon, DifferenceOfAHoleIsFourParallelograms) {
  const Polygon hole{{0.25, 0.25, 0}, {0.5, 0.25, 0}, {0.5, 0.75, 0}, {0.25, 0.75, 0}};
  double covered = 0;
  const auto parts = difference(kSquare, hole, kUp, 1e-9, covered);
  EXPECT_DOUBLE_EQ(covered, 0.125);
  ASSERT_EQ(parts.size(), 4u);
  double sum = 0;
  for (const Polygon& part : parts) {
    const auto outlines = to_outlines(part, 1e-12);
    ASSERT_EQ(outlines.size(), 1u);
    EXPECT_EQ(outlines[0].corners, 4u);
    sum += area(part);
  }
  EXPECT_DOUBLE_EQ(sum, 0.875);
}

TEST(Polygon, OutlinesAreWellShaped) {
  const Polygon hexagon = regular(6);
  const auto outlines = to_outlines(hexagon, 1e-12);
  EXPECT_EQ(outlines.size(), 4u);
  EXPECT_NEAR(total_area(outlines), area(hexagon), 1e-15);
  // Only one diagonal of a kite is good, wherever its corners start.
  Polygon kite{{0, 0, 0}, {2, -0.1, 0}, {4, 0, 0}, {2, 3, 0}};
  for (int turn = 0; turn < 4; ++turn) {
    for (const auto& outline : to_outlines(kite, 1e-12)) EXPECT_GT(width(corners(outline), kUp), 1);
    std::rotate(kite.begin(), kite.begin() + 1, kite.end());
  }
}

TEST(Polygon, OutlinesOfManyCornersKeepTheArea) {
  const Polygon round = regular(100);
  const auto outlines = to_outlines(round, 1e-12);
  EXPECT_EQ(outlines.size(), 98u);
  EXPECT_NEAR(total_area(outlines), area(round), 1e-13);
  for (const auto& outline : outlines) EXPECT_GT(area_vector(corners(outline)).z, 0);
}

TEST(Polygon, OnlyAParallelogramStaysOne) {
  EXPECT_EQ(to_outlines(kSquare, 1e-12).size(), 1u);
  Polygon bent = kSquare;
  bent[2].x += 1e-6;
  EXPECT_EQ(to_outlines(bent, 1e-12).size(), 2u);
}

}  // namespace
}  // namespace fluxel
