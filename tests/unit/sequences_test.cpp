#include <gtest/gtest.h>

#include <boost/random/sobol.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "bench/sequences/generators.hpp"
#include "sampling/halton.hpp"
#include "sampling/random_sequence.hpp"
#include "sampling/sobol.hpp"
#include "tests/plain_sequences.hpp"

namespace fluxel {
namespace {

constexpr std::uint64_t kLargest = std::numeric_limits<std::int64_t>::max();

/// Where sequences are compared: at the beginning, around 2^32, and up to 2^63 - 1.
std::vector<std::uint64_t> starts_of(std::uint64_t step, std::uint64_t count) {
  return {0, (std::uint64_t{1} << 32) - step * count / 2, kLargest - step * (count - 1)};
}

constexpr std::uint64_t kComparedSteps[] = {1, 2, 3, 7, 20, 200, 2000, 20000};

TEST(HaltonSequence, AreThoseOfTheDefinitionToTheLastBit) {
  for (const std::uint64_t step : kComparedSteps)
    for (const std::uint64_t start : starts_of(step, 2000)) {
      HaltonSequence points;
      for (std::uint64_t k = 0; k < 2000; ++k) {
        points.start(start + k * step);
        for (std::size_t dimension = 0; dimension < HaltonSequence::kDimensions; ++dimension)
          ASSERT_EQ(points.next(), test::plain_halton(start + k * step, HaltonSequence::bases()[dimension]))
              << start + k * step << " by " << step << ", dimension " << dimension;
      }
    }
}

TEST(HaltonSequence, EveryStepUpTo20000) {
  HaltonSequence points;
  std::uint64_t index = 0;
  for (std::uint64_t step = 1; step <= 20000; ++step) {
    index += step;
    points.start(index);
    for (std::size_t dimension = 0; dimension < 8; ++dimension)
      ASSERT_EQ(points.next(), test::plain_halton(index, HaltonSequence::bases()[dimension]));
  }
}

// As photons that are absorbed draw them: of some points only the first ones, and not in order.
TEST(HaltonSequence, NeedNoPointBefore) {
  HaltonSequence halton;
  SobolSequence sobol;
  RandomSequence numbers(7);
  for (std::uint64_t k = 0; k < 20000; ++k) {
    numbers.start(k);
    const auto index = static_cast<std::uint64_t>(std::ldexp(numbers.next(), 1 + static_cast<int>(k % 63)));
    const auto drawn = static_cast<std::size_t>(64 * numbers.next());
    halton.start(index);
    sobol.start(index);
    for (std::size_t dimension = 0; dimension < drawn; ++dimension) {
      ASSERT_EQ(halton.next(), test::plain_halton(index, HaltonSequence::bases()[dimension]));
      ASSERT_EQ(sobol.next(), test::plain_sobol(index, dimension));
    }
  }
}

// 0.4321 of 1234 in base 10, the example of the paper; in base 7 1234 is 3412.
TEST(HaltonSequence, DigitsAreReversed) {
  EXPECT_DOUBLE_EQ(test::plain_halton(1234, HaltonBase(10)), 0.4321);
  EXPECT_DOUBLE_EQ(test::plain_halton(1234, HaltonBase(7)), 2.0 / 7 + 1.0 / 49 + 4.0 / 343 + 3.0 / 2401);
  for (const HaltonBase& of : HaltonSequence::bases()) {
    EXPECT_LT(test::plain_halton(std::numeric_limits<std::uint64_t>::max(), of), 1);
    EXPECT_DOUBLE_EQ(test::plain_halton(1, of), 1.0 / of.base);
  }
}

// Equation 17: points whose indices differ by a multiple of base^k begin alike.
TEST(HaltonSequence, AreNearlyPeriodic) {
  for (std::size_t dimension = 0; dimension < 4; ++dimension) {
    const HaltonBase& of = HaltonSequence::bases()[dimension];
    std::uint64_t power = 1;
    for (int k = 0; k <= 6; ++k, power *= of.base)
      for (std::uint64_t index = 0; index < 500; ++index)
        for (const std::uint64_t multiple : {1u, 2u, 1000003u}) {
          const double far =
              std::abs(test::plain_halton(index, of) - test::plain_halton(index + multiple * power, of));
          ASSERT_LT(far, 1.0 / static_cast<double>(power));
        }
    // And not for others: half a period takes base 2 to the other half.
    if (dimension == 0) {
      EXPECT_EQ(std::abs(test::plain_halton(8, of) - test::plain_halton(9, of)), 0.5);
    }
  }
}

TEST(SobolSequence, AreThoseOfTheDefinitionToTheLastBit) {
  for (const std::uint64_t step : kComparedSteps)
    for (const std::uint64_t start : starts_of(step, 1000)) {
      SobolSequence points;
      for (std::uint64_t k = 0; k < 1000; ++k) {
        points.start(start + k * step);
        for (std::size_t dimension = 0; dimension < SobolSequence::kDimensions; ++dimension)
          ASSERT_EQ(points.next(), test::plain_sobol(start + k * step, dimension));
      }
    }
  SobolSequence points;
  std::uint64_t index = 0;
  for (std::uint64_t step = 1; step <= 20000; ++step) {
    index += step;
    points.start(index);
    for (std::size_t dimension = 0; dimension < 8; ++dimension)
      ASSERT_EQ(points.next(), test::plain_sobol(index, dimension));
  }
}

// Boost has the same points in the order of Gray's code, without the origin.
TEST(SobolSequence, AreThoseOfBoost) {
  boost::random::sobol engine(SobolSequence::kDimensions);
  SobolSequence points;
  for (std::uint64_t number = 1; number < 4096; ++number) {
    points.start(number ^ number >> 1);
    for (std::size_t dimension = 0; dimension < SobolSequence::kDimensions; ++dimension)
      ASSERT_EQ(points.next(), SobolSequence::value(engine()));
  }
}

/// The largest t for which 2^v points from a multiple of 2^v on are no (t, v, s)-net: in some binary box of
/// volume 2^(t - v) (equation 8) are not 2^t of them. -1: there is none.
int largest_violation(std::uint64_t first, int v, std::size_t dimensions) {
  SobolSequence points;
  std::vector<std::vector<double>> x(dimensions, std::vector<double>(std::size_t{1} << v));
  for (std::uint64_t k = 0; k < std::uint64_t{1} << v; ++k) {
    points.start(first + k);
    for (std::size_t dimension = 0; dimension < dimensions; ++dimension) x[dimension][k] = points.next();
  }
  int worst = -1;
  // Shapes of boxes: how often each axis is halved.
  std::vector<int> halved(dimensions, 0);
  const auto check = [&](int t) {
    std::vector<std::uint32_t> inside(std::size_t{1} << (v - t), 0);
    for (std::size_t k = 0; k < x[0].size(); ++k) {
      std::size_t box = 0;
      for (std::size_t dimension = 0; dimension < dimensions; ++dimension)
        box = (box << halved[dimension]) |
              static_cast<std::size_t>(std::ldexp(x[dimension][k], halved[dimension]));
      ++inside[box];
    }
    return std::ranges::all_of(inside, [&](std::uint32_t count) { return count == std::uint32_t{1} << t; });
  };
  for (int t = v; t >= 0; --t) {
    const auto all_shapes = [&](auto&& self, std::size_t axis, int left) -> bool {
      if (axis + 1 == dimensions) {
        halved[axis] = left;
        return check(t);
      }
      for (int k = 0; k <= left; ++k) {
        halved[axis] = k;
        if (!self(self, axis + 1, left - k)) return false;
      }
      return true;
    };
    if (!all_shapes(all_shapes, 0, v - t)) worst = std::max(worst, t);
  }
  return worst;
}

// t is at most the sum of the polynomials' degrees less one each (Sobol 1967): 0 for two dimensions, 1 for
// three, 3 for four.
TEST(SobolSequence, EverySectionIsANet) {
  for (const std::uint64_t section : {0u, 1u, 5u, 1000u}) {
    EXPECT_EQ(largest_violation(section << 10, 10, 2), -1);
    EXPECT_LT(largest_violation(section << 9, 9, 3), 1);
    EXPECT_LT(largest_violation(section << 9, 9, 4), 3);
  }
  // A section that does not begin at a multiple of its length is none.
  EXPECT_GT(largest_violation(3, 10, 2), -1);
}

/// What other ways to make points, which are timed, are off by, at most, in five dimensions.
template <class Generator>
double farthest(std::uint64_t step, const auto& definition) {
  Generator points;
  double far = 0;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    points.start(k * step);
    for (std::size_t dimension = 0; dimension < bench::kDimensions; ++dimension)
      far = std::max(far, std::abs(points.next() - definition(k * step, dimension)));
  }
  return far;
}

// Those that sum in doubles are off by their last bits.
TEST(TimedSequences, AreThoseOfTheDefinition) {
  const auto halton = [](std::uint64_t index, std::size_t dimension) {
    return test::plain_halton(index, HaltonSequence::bases()[dimension]);
  };
  constexpr double kLastBits = 1e-15;
  for (const std::uint64_t step : kComparedSteps) {
    EXPECT_LT(farthest<bench::PlainHalton>(step, halton), kLastBits) << step;
    EXPECT_LT(farthest<bench::PlainHaltonOfConstants>(step, halton), kLastBits) << step;
    EXPECT_LT(farthest<bench::DecomposedHalton>(step, halton), kLastBits) << step;
    EXPECT_LT(farthest<bench::RecurrentHalton>(step, halton), kLastBits) << step;
    EXPECT_EQ(farthest<bench::PlainSobol>(step, test::plain_sobol), 0) << step;
    EXPECT_EQ(farthest<bench::ShortSobol>(step, test::plain_sobol), 0) << step;
  }
  EXPECT_LT(farthest<bench::KellerHalton>(1, halton), 1e-6) << "drifts";
  const auto in_order_of_gray = [](std::uint64_t index, std::size_t dimension) {
    return test::plain_sobol(index ^ index >> 1, dimension);
  };
  EXPECT_EQ(farthest<bench::GraySobol>(1, in_order_of_gray), 0);
}

TEST(RandomSequence, LookRandom) {
  constexpr std::uint64_t kCount = 100000;
  RandomSequence points(1), others(2);
  double sum = 0, with_next = 0, with_other = 0, along = 0, last = 0;
  std::vector<int> of_tenths(10, 0);
  for (std::uint64_t k = 0; k < kCount; ++k) {
    points.start(k);
    others.start(k);
    const double x = points.next(), y = points.next(), z = others.next();
    ++of_tenths[static_cast<std::size_t>(10 * x)];
    sum += x;
    with_next += (x - 0.5) * (y - 0.5);
    with_other += (x - 0.5) * (z - 0.5);
    along += (x - 0.5) * (last - 0.5);
    last = x;
  }
  const double expected = kCount / 10.0;
  double chi_squared = 0;
  for (const int count : of_tenths) chi_squared += (count - expected) * (count - expected) / expected;
  EXPECT_LT(chi_squared, 27.9) << "9 degrees of freedom, a chance of 0.1 %";
  EXPECT_NEAR(sum / kCount, 0.5, 4 * std::sqrt(1 / 12.0 / kCount));
  for (const double covariance : {with_next, with_other, along})
    EXPECT_NEAR(covariance / kCount, 0, 4 * std::sqrt(1 / 144.0 / kCount));
}

}  // namespace
}  // namespace fluxel
