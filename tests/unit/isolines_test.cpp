#include "image/isolines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fluxel {
namespace {

TEST(Isolines, FollowAPlane) {
  constexpr int kSide = 6;
  std::vector<double> values;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) values.push_back(2 * (column + 0.5) + 3 * (row + 0.5));
  const auto lines = isolines(values, kSide, 14.2);
  ASSERT_FALSE(lines.empty());
  for (const auto& line : lines)
    for (const glm::dvec2& end : line) EXPECT_NEAR(2 * end.x + 3 * end.y, 14.2, 1e-12);
}

TEST(Isolines, CloseAroundAHill) {
  // As long as the circle, each end met by another piece.
  constexpr int kSide = 40;
  constexpr double kRadius = 12;
  std::vector<double> values;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      values.push_back(-std::hypot(column + 0.5 - 20, row + 0.5 - 20));
  double length = 0;
  for (const auto& [from, to] : isolines(values, kSide, -kRadius)) {
    length += std::hypot(to.x - from.x, to.y - from.y);
    EXPECT_NEAR(std::hypot(from.x - 20, from.y - 20), kRadius, 0.05);
  }
  EXPECT_NEAR(length, 2 * 3.14159265358979 * kRadius, 0.1);
}

TEST(Isolines, SaddlesAreCutByTheirMiddle) {
  // High corners on one diagonal: joined where the middle is high, apart where it is low.
  const std::vector<double> high{10, 4, 4, 10}, low{6, 0, 0, 6};
  const auto joined = isolines(high, 2, 5), apart = isolines(low, 2, 5);
  ASSERT_EQ(joined.size(), 2u);
  ASSERT_EQ(apart.size(), 2u);
  // The line nearest to the first corner's diagonal neighbour cuts off a low corner, or a high one.
  const auto cuts_first_corner = [](const std::vector<std::array<glm::dvec2, 2>>& lines) {
    for (const auto& [from, to] : lines)
      if (from.x + from.y + to.x + to.y < 3) return true;
    return false;
  };
  EXPECT_FALSE(cuts_first_corner(joined));
  EXPECT_TRUE(cuts_first_corner(apart));
}

TEST(Isolines, ThereAreNoneBesideWhatWasNotMeasured) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> values{0, 1, 0, none};
  EXPECT_TRUE(isolines(values, 2, 0.5).empty());
}

}  // namespace
}  // namespace fluxel
