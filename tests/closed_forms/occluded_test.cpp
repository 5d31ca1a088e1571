#include "tests/closed_forms/occluded.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/closed_forms/points.hpp"
#include "tests/closed_forms/quadrature.hpp"

namespace fluxel::closed_forms {
namespace {

double past(const Rectangle& blocker) { return opposed_squares_past({&blocker, 1}); }

TEST(Occluded, BlockerCheckValues) {
  const double free = opposed_rectangles(1, 1, 1);
  EXPECT_NEAR(past({0, 0.5, 0, 1}), 0.0999124478491935, 1e-15);
  EXPECT_NEAR(past({0, 0.5, 0, 0.5}), 0.149868671773790, 1e-15);
  EXPECT_NEAR(past({0, 0.5, 0, 1}), free / 2, 1e-15);
  EXPECT_NEAR(past({0.5, 1, 0, 0.5}), 0.75 * free, 1e-15);
  EXPECT_NEAR(past({0, 1, 0, 1}), 0, 1e-15);
  EXPECT_NEAR(past(centred_blocker(0.25)), 0.169474204911786, 1e-15);
  EXPECT_NEAR(past(centred_blocker(0.5)), 0.0995062945989844, 1e-15);
}

TEST(Occluded, BlockersAdd) {
  const Rectangle left{0.1, 0.3, 0.2, 0.9}, right{0.3, 0.6, 0.2, 0.9};
  const std::array both{left, right};
  EXPECT_NEAR(opposed_squares_past(both), past({0.1, 0.6, 0.2, 0.9}), 1e-15);
  EXPECT_NEAR(past(left), past({0.7, 0.9, 0.1, 0.8}), 1e-15);  // turned by half a turn
}

/// Sums the kernel over pairs of cell centres, the segment's middle against the blocker: knows nothing of
/// shadows. Middles are multiples of 1/80; a blocker's edges should lie half way between.
double counted(const Rectangle& blocker) {
  constexpr int kCells = 40;
  const auto centre = [](int i) { return (i + 0.5) / kCells; };
  const auto within = [](double low, double x, double high) { return low < x && x < high; };
  // x and y are independent but for the kernel: count pairs by distance and by their middles' side.
  std::array<std::array<double, 2>, kCells> x_pairs{}, y_pairs{};
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const double middle = (centre(i) + centre(j)) / 2;
      const auto apart = static_cast<std::size_t>(std::abs(i - j));
      ++x_pairs[apart][within(blocker.u_low, middle, blocker.u_high) ? 1 : 0];
      ++y_pairs[apart][within(blocker.v_low, middle, blocker.v_high) ? 1 : 0];
    }
  }
  double sum = 0;
  for (std::size_t i = 0; i < kCells; ++i) {
    for (std::size_t j = 0; j < kCells; ++j) {
      const double all = (x_pairs[i][0] + x_pairs[i][1]) * (y_pairs[j][0] + y_pairs[j][1]);
      const double square = 1 + double(i * i + j * j) / (kCells * kCells);
      sum += (all - x_pairs[i][1] * y_pairs[j][1]) / (std::numbers::pi * square * square);
    }
  }
  return sum / std::pow(kCells, 4);
}

TEST(Occluded, BlockersAgainstCounting) {
  EXPECT_NEAR(counted({2, 3, 2, 3}), opposed_rectangles(1, 1, 1), 1e-4);  // what counting can do
  const double low = 20.5 / 80, high = 59.5 / 80;
  for (const Rectangle blocker :
       {Rectangle{low, high, low, high}, Rectangle{16.5 / 80, 48.5 / 80, -1, high}}) {
    EXPECT_NEAR(counted(blocker), past(blocker), 2e-4);
  }
}

TEST(Occluded, CorridorByStrings) {
  EXPECT_NEAR(l_corridor(3, 1), (6 - 2 * std::sqrt(5)) / 6, 1e-15);
  EXPECT_NEAR(l_corridor(3, 1), 0.254644007500070, 1e-15);
  EXPECT_NEAR(l_corridor(3, 1.5), 0.292893218813453, 1e-15);  // the corner just touches the longest string
  EXPECT_NEAR(l_corridor(3, 2), 1 - std::numbers::sqrt2 / 2, 1e-15);
  // Opposed strips of width 2 at distance 1.
  EXPECT_NEAR(crossed_strings({.crossed = 2 * std::sqrt(5), .uncrossed = 2}, 2), std::hypot(1, 0.5) - 0.5,
              1e-15);
}

TEST(Occluded, RoomCheckValues) {
  EXPECT_NEAR(l_room(3, 1, 3), 0.182355903668596, 1e-14);
  EXPECT_NEAR(l_room(3, 1.5, 3), 0.200043776075403, 1e-14);
}

// The same by point factors over the sender, with the visible part of each point's own.
TEST(Occluded, RoomAgainstPoints) {
  const double arm = 3, width = 1, height = 3;
  const auto column = [&](double c) {
    const double visible = c <= 1.5 ? arm : width * c / (c - width);
    return integrate<30>(0, height, [&](double z) {
      return point_to_perpendicular_rectangle(
          c, {.u_low = 0, .u_high = visible, .v_low = -z, .v_high = height - z});
    });
  };
  // From c = 1.5 on; the part before sees all of the wall and is C-14.
  const double hidden = integrate<30>(1.5, arm, column);
  const double whole = 1.5 * height * adjacent_rectangles(1.5, arm, height);
  EXPECT_NEAR(l_room(arm, width, height), (hidden + whole) / (arm * height), 1e-13);
}

TEST(Occluded, HighRoomIsACorridor) {
  // The open ends lose a strip about as high as the room is wide.
  EXPECT_NEAR(l_room(3, 1, 1e6), l_corridor(3, 1), 1e-5);
  EXPECT_LT(l_room(3, 1, 100), l_corridor(3, 1));
}

}  // namespace
}  // namespace fluxel::closed_forms
