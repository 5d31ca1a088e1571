#include "solver/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "solver/reductions.hpp"
#include "tests/unit/virtual_ranks.hpp"

namespace fluxel {
namespace {

using Words = std::array<std::uint64_t, ExactSum::kWords>;

double sum_of(const std::vector<double>& terms) {
  Words words{};
  ExactSum sum(words);
  for (const double term : terms) sum.add(term);
  return sum.value();
}

constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
constexpr double kLargest = std::numeric_limits<double>::max();

TEST(ExactSum, OfNothingIsZero) { EXPECT_EQ(sum_of({}), 0); }

TEST(ExactSum, OfOneNumberIsThatNumber) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(1, 2);
  for (int exponent = -1074; exponent <= 1023; ++exponent) {
    for (const double sign : {1.0, -1.0}) {
      const double x = sign * std::ldexp(mantissa(random), exponent);
      EXPECT_EQ(sum_of({x}), x) << exponent;
    }
  }
  for (const double x : {kSmallest, std::numeric_limits<double>::min(), kLargest}) EXPECT_EQ(sum_of({x}), x);
}

TEST(ExactSum, NothingIsLostBesideWhatIsLarge) {
  EXPECT_EQ(sum_of({kLargest, 1, kSmallest, -kLargest, -1}), kSmallest);
  EXPECT_EQ(sum_of({kLargest, kLargest, -kLargest}), kLargest) << "beyond a double on the way";
  EXPECT_EQ(sum_of({1e300, 3, -1e300}), 3);
  EXPECT_EQ(sum_of({1, -1 - 0x1p-52}), -0x1p-52);
}

// Sums of whole numbers, which doubles hold exactly.
TEST(ExactSum, OfManyWholeNumbers) {
  std::mt19937_64 random(2);
  std::vector<double> terms;
  std::int64_t expected = 0;
  for (int k = 0; k < 100'000; ++k) {
    const std::int64_t term = static_cast<std::int64_t>(random() % (std::uint64_t{1} << 34)) - (1ll << 33);
    expected += term;
    terms.push_back(std::ldexp(static_cast<double>(term), -40));
  }
  EXPECT_EQ(sum_of(terms), std::ldexp(static_cast<double>(expected), -40));
}

TEST(ExactSum, IsRoundedAlikeInEveryUnit) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> value;
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> terms(20);
    for (double& term : terms) term = value(random);
    const double expected = sum_of(terms);
    for (int exponent = -64; exponent <= 64; ++exponent) {
      std::vector<double> scaled = terms;
      for (double& term : scaled) term = std::ldexp(term, exponent);
      EXPECT_EQ(std::ldexp(sum_of(scaled), -exponent), expected) << exponent;
    }
  }
}

TEST(ExactSum, IsTheSameInEveryOrderAndWithinOneUnit) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> value;
  std::vector<double> terms;
  for (int k = 0; k < 1000; ++k)
    terms.push_back(std::ldexp(value(random), static_cast<int>(random() % 60) - 30));
  long double expected = 0;  // 11 bits more
  for (const double term : terms) expected += term;
  const double sum = sum_of(terms);
  EXPECT_NEAR(sum, static_cast<double>(expected), 2 * std::abs(sum) * 0x1p-52);
  for (int repeat = 0; repeat < 10; ++repeat) {
    std::ranges::shuffle(terms, random);
    EXPECT_EQ(sum_of(terms), sum);
  }
}

TEST(ExactSum, OfWhatIsNotFiniteIsNoNumber) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_TRUE(std::isnan(sum_of({1, wrong, 2})));
  EXPECT_EQ(sum_of({kLargest, kLargest}), kInfinity);
  EXPECT_EQ(sum_of({-kLargest, -kLargest}), -kInfinity);
}

/// Parts of some entries, in turn longer and shorter; the second of three ranks or more has none.
std::pair<std::size_t, std::size_t> part_of_rank(const Ranks& ranks, std::size_t size) {
  const auto first = [&](std::size_t rank) {
    return rank == 2 && ranks.size > 2 ? size / ranks.size : size * rank / ranks.size;
  };
  return {first(ranks.rank), first(ranks.rank + 1)};
}

TEST(Reductions, HaveTheSameBytesForEveryNumberOfRanks) {
  constexpr std::size_t kSize = 1001;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<Rgb> x(kSize), y(kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    x[i] = {value(random), 1e10 * value(random), value(random)};
    y[i] = {value(random), value(random), 1e-200 * value(random)};
  }
  const std::span<const Rgb> all_x = x, all_y = y;
  const Rgb whole = dot(Ranks{}, all_x, all_y);
  Rgb plain(0), most(0);
  for (std::size_t i = 0; i < kSize; ++i) {
    plain += x[i] * y[i];
    most = glm::max(most, x[i]);
  }
  for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(whole[c], plain[c], 1e-13 * kSize * most[c]);
  for (const std::size_t count : {1u, 2u, 3u, 7u}) {
    std::vector<Rgb> sums(count), largest(count);
    test_scenes::VirtualRanks::run(count, [&](const Ranks& ranks) {
      const auto [first, last] = part_of_rank(ranks, kSize);
      sums[ranks.rank] = dot(ranks, all_x.subspan(first, last - first), all_y.subspan(first, last - first));
      Rgb own(0);
      for (std::size_t i = first; i < last; ++i) own = glm::max(own, x[i]);
      largest[ranks.rank] = largest_over(ranks, own);
    });
    EXPECT_EQ(sums, std::vector<Rgb>(count, whole));
    EXPECT_EQ(largest, std::vector<Rgb>(count, most));
  }
}

}  // namespace
}  // namespace fluxel
