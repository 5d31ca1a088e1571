#include "sampling/owen_sobol.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace fluxel {
namespace {

using Point = std::array<double, OwenSobol::kAxes>;

/// The first points of a seed, in one of its groups of dimensions.
std::vector<Point> first_points(std::uint64_t seed, std::uint32_t count, int group = 0) {
  std::vector<Point> points;
  for (std::uint32_t index = 0; index < count; ++index) {
    OwenSobol numbers(seed, index);
    for (int skipped = 0; skipped < group; ++skipped) numbers.next();
    points.push_back(numbers.next());
  }
  return points;
}

std::size_t cell(double x, std::size_t cells) {
  return static_cast<std::size_t>(x * static_cast<double>(cells));
}

double mean(const std::vector<double>& of) {
  double sum = 0;
  for (const double x : of) sum += x;
  return sum / static_cast<double>(of.size());
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const double mean_x = mean(x), mean_y = mean(y);
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x);
    yy += (y[k] - mean_y) * (y[k] - mean_y);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return xy / std::sqrt(xx * yy);
}

/// Smooth in all four axes; 1 on average.
double smooth(const Point& x) {
  double product = 1;
  for (const double of_axis : x) product *= 2 * of_axis;
  return product;
}

/// Errors of the mean of `smooth` over the first points of each of many seeds.
std::vector<double> errors_of_seeds(std::uint64_t first_seed, std::size_t seeds, std::uint32_t points) {
  std::vector<double> errors;
  for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
    double sum = 0;
    for (const Point& point : first_points(seed, points)) sum += smooth(point);
    errors.push_back(sum / points - 1);
  }
  return errors;
}

TEST(OwenSobol, EachOfAPowerOfTwoIsInAStratumOfItsOwn) {
  for (const std::uint64_t seed : {0ull, 1ull, 0xFFFFFFFFFFFFFFFFull}) {
    for (const int group : {0, 1, 5}) {
      const std::vector<Point> points = first_points(seed, 1024, group);
      for (const Point& point : points)
        for (const double x : point) ASSERT_TRUE(x > 0 && x < 1);
      for (std::size_t count = 1; count <= points.size(); count *= 2) {
        for (std::size_t axis = 0; axis < OwenSobol::kAxes; ++axis) {
          std::set<std::size_t> strata;
          for (std::size_t k = 0; k < count; ++k) strata.insert(cell(points[k][axis], count));
          ASSERT_EQ(strata.size(), count) << "axis " << axis << " of group " << group;
        }
      }
    }
  }
}

/// 2^most, where each box of 2^-a x 2^-b holds 2^most of 2^(a + b + most) points in the two axes.
std::size_t points_a_box(const std::vector<Point>& points, std::size_t u, std::size_t v, std::size_t boxes) {
  for (std::size_t wide = 1; wide <= boxes; wide *= 2) {
    std::vector<std::size_t> held(boxes, 0);
    const std::size_t high = boxes / wide;
    for (const Point& point : points) ++held[cell(point[u], wide) * high + cell(point[v], high)];
    for (const std::size_t of_box : held)
      if (of_box != points.size() / boxes) return 0;
  }
  return points.size() / boxes;
}

// The quality t of Sobol's nets: one point a box for the first two axes, in every box 2^t for the others.
TEST(OwenSobol, PairsOfAxesFillEveryBox) {
  for (const std::uint64_t seed : {7ull, 1234567ull}) {
    for (const int group : {0, 2}) {
      const std::vector<Point> points = first_points(seed, 256, group);
      EXPECT_EQ(points_a_box(points, 0, 1, 256), 1u);
      for (const auto& [u, v] : {std::pair<std::size_t, std::size_t>{0, 2}, {1, 2}}) {
        EXPECT_EQ(points_a_box(points, u, v, 128), 2u) << u << ' ' << v;
      }
      EXPECT_EQ(points_a_box(points, 2, 3, 32), 8u);
    }
  }
}

// Without a trend: the mean over seeds is right, and seeds err far less than independent numbers do, whose
// variance is ((4/3)^4 - 1) / n.
TEST(OwenSobol, MeansAreUnbiasedAndBetterThanRandom) {
  constexpr std::size_t kSeeds = 4000;
  for (const std::uint32_t points : {1u, 3u, 16u, 64u}) {
    const std::vector<double> errors = errors_of_seeds(100, kSeeds, points);
    double squares = 0;
    for (const double error : errors) squares += error * error;
    const double deviation = std::sqrt(squares / kSeeds);
    EXPECT_LT(std::abs(mean(errors)), 3.5 * deviation / std::sqrt(kSeeds)) << points;
    const double random = std::sqrt((std::pow(4.0 / 3, 4) - 1) / points);
    EXPECT_LT(deviation, points < 16 ? 1.1 * random : points < 64 ? 0.4 * random : 0.25 * random) << points;
  }
}

TEST(OwenSobol, SeedsErrIndependently) {
  constexpr std::size_t kSeeds = 4000;
  const std::vector<double> errors = errors_of_seeds(1, kSeeds + 1, 16);
  const std::vector<double> first(errors.begin(), errors.end() - 1), next(errors.begin() + 1, errors.end());
  EXPECT_LT(std::abs(correlation(first, next)), 4 / std::sqrt(kSeeds));
}

// Else a path's next direction would depend on where it began.
TEST(OwenSobol, GroupsAreEvenApartOnly) {
  constexpr std::uint32_t kPoints = 4096;
  const std::vector<Point> first = first_points(3, kPoints), second = first_points(3, kPoints, 1);
  std::vector<double> single;
  single.reserve(kPoints);
  for (std::uint32_t index = 0; index < kPoints; ++index) single.push_back(OwenSobol(3, index).next_random());
  const auto axis = [](const std::vector<Point>& points, std::size_t of) {
    std::vector<double> values;
    for (const Point& point : points) values.push_back(point[of]);
    return values;
  };
  const double most = 4 / std::sqrt(kPoints);
  for (std::size_t u = 0; u < OwenSobol::kAxes; ++u) {
    for (std::size_t v = 0; v < OwenSobol::kAxes; ++v)
      EXPECT_LT(std::abs(correlation(axis(first, u), axis(second, v))), most) << u << ' ' << v;
    EXPECT_LT(std::abs(correlation(axis(first, u), single)), most) << u;
  }
}

TEST(OwenSobol, SingleNumbersAreUniform) {
  constexpr std::uint32_t kNumbers = 16000;
  std::array<double, 10> counts{};
  for (std::uint32_t index = 0; index < kNumbers; ++index) {
    OwenSobol numbers(11, index);
    numbers.next();
    counts[cell(numbers.next_random(), counts.size())] += 1;
  }
  double chi_squared = 0;
  for (const double count : counts) chi_squared += (count - 1600) * (count - 1600) / 1600;
  EXPECT_LT(chi_squared, 27.9);  // 9 degrees of freedom, 1 in 1000
  EXPECT_GT(chi_squared, 1.15) << "even, not random";
}

}  // namespace
}  // namespace fluxel
