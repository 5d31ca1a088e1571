#include "metrics/signed_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "metrics/diverging_colours.hpp"

namespace fluxel {
namespace {

using Values = std::vector<Rgb>;

TEST(SignedErrors, AreOverTheMeanOfTheReference) {
  const Values reference{Rgb(2, 1, 0), Rgb(6, 3, 0)}, judged{Rgb(3, 1, 0), Rgb(6, 1, 0)};
  const std::vector<double> weights{1, 1};
  const FieldErrors errors = compare_fields({judged}, {reference}, weights);
  const Values differences = relative_differences({judged}, {reference}, errors);
  EXPECT_EQ(differences[0], Rgb(0.25, 0, 0));
  EXPECT_EQ(differences[1], Rgb(0, -1, 0));
  const std::vector<double> overall = overall_differences({judged}, {reference}, errors);
  EXPECT_DOUBLE_EQ(overall[0], 1.0 / 6);
  EXPECT_DOUBLE_EQ(overall[1], -2.0 / 6);
}

TEST(SignedErrors, OfADarkReferenceAre0) {
  const Values reference{Rgb(0)}, judged{Rgb(1)};
  const FieldErrors errors = compare_fields({judged}, {reference}, std::vector<double>{1});
  EXPECT_EQ(relative_differences({judged}, {reference}, errors)[0], Rgb(0));
  EXPECT_EQ(overall_differences({judged}, {reference}, errors)[0], 0);
}

TEST(SymmetricRange, IsOneTwoOrFiveTimesAPowerOfTen) {
  const std::vector<double> one{1};
  const auto range = [&](double value) { return symmetric_range(std::vector<double>{value}, one); };
  EXPECT_DOUBLE_EQ(range(-0.011), 0.02);
  EXPECT_DOUBLE_EQ(range(0.03), 0.05);
  EXPECT_DOUBLE_EQ(range(0.051), 0.1);
  EXPECT_DOUBLE_EQ(range(1), 1);
  EXPECT_DOUBLE_EQ(range(7e3), 1e4);
  EXPECT_DOUBLE_EQ(range(0), 1e-6);
  // A hundredth of the weight may lie outside.
  EXPECT_DOUBLE_EQ(symmetric_range(std::vector<double>{0.1, -30}, std::vector<double>{199, 1}), 0.1);
}

TEST(HistogramOfErrors, CountsWeightInEveryBinOnce) {
  const Values values{Rgb(0, 0.5, -2), Rgb(0, -0.5, 2), Rgb(0.1, 1, 1)};
  const Histogram histogram = histogram_of(values, std::vector<double>{1, 1, 2}, 1);
  ASSERT_EQ(histogram.shares.size(), Histogram::kInside + 2);
  const Rgb total = std::accumulate(histogram.shares.begin(), histogram.shares.end(), Rgb(0));
  EXPECT_EQ(total, Rgb(1));
  EXPECT_EQ(histogram.shares[Histogram::kInside / 2 + 1].r, 0.5);  // 0 is in the middle
  EXPECT_EQ(histogram.shares.front().b, 0.25);
  EXPECT_EQ(histogram.shares.back().b, 0.75);  // a bin ends before its end
  EXPECT_TRUE(std::isinf(histogram.begin(0)));
  EXPECT_EQ(histogram.begin(1), -1);
  EXPECT_EQ(histogram.begin(Histogram::kInside + 1), 1);
  EXPECT_TRUE(std::isinf(histogram.begin(Histogram::kInside + 2)));
  for (std::size_t bin = 0; bin < histogram.shares.size(); ++bin) {
    if (histogram.shares[bin].g == 0.25 && bin > Histogram::kInside / 2) {
      EXPECT_LE(histogram.begin(bin), 0.5);
      EXPECT_GT(histogram.begin(bin + 1), 0.5);
    }
  }
}

TEST(DivergingColours, AreBlueBelowAndRedAbove) {
  const auto colours = diverging_colours(std::vector<double>{-5, -2, 0, 2, 5, 1}, 2);
  ASSERT_EQ(colours.size(), 18u);
  const auto colour = [&](std::size_t i) {
    return std::vector<int>(colours.begin() + static_cast<std::ptrdiff_t>(3 * i),
                            colours.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
  };
  EXPECT_EQ(colour(0), (std::vector<int>{5, 48, 97}));
  EXPECT_EQ(colour(1), colour(0));
  EXPECT_EQ(colour(2), (std::vector<int>{247, 247, 247}));
  EXPECT_EQ(colour(4), (std::vector<int>{103, 0, 31}));
  EXPECT_EQ(colour(3), colour(4));
  // Half way between the stops 7 and 8: (244, 165, 130) and (214, 96, 77).
  EXPECT_EQ(colour(5), (std::vector<int>{229, 131, 104}));
}

}  // namespace
}  // namespace fluxel
