#include "metrics/field_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace fluxel {
namespace {

using Values = std::vector<Rgb>;

TEST(FieldErrors, OfAFieldAgainstItselfAre0) {
  const Values values{Rgb(1, 2, 3), Rgb(4, 5, 6)};
  const FieldErrors errors = compare_fields({values}, {values}, std::vector<double>{1, 2});
  EXPECT_EQ(errors.figure(), 0);
  for (const auto& colour : errors.colours) {
    ASSERT_TRUE(colour);
    EXPECT_EQ(colour->sigma, 0);
    EXPECT_EQ(colour->bias, 0);
    EXPECT_EQ(colour->largest, 0);
    EXPECT_FALSE(colour->noise_free);
  }
}

// By hand: weights 1 and 3, B = 2 and 6, A = 4 and 5. The mean of B is 5, of B^2 28; A - B = 2 and -1.
TEST(FieldErrors, AreThoseComputedByHand) {
  const Values reference{Rgb(2), Rgb(6)}, judged{Rgb(4), Rgb(5)};
  const FieldErrors errors = compare_fields({judged}, {reference}, std::vector<double>{1, 3});
  for (const auto& colour : errors.colours) {
    ASSERT_TRUE(colour);
    EXPECT_DOUBLE_EQ(colour->mean, 5);
    EXPECT_DOUBLE_EQ(colour->quadratic_mean, std::sqrt(28.0));
    EXPECT_DOUBLE_EQ(colour->judged_mean, 4.75);
    EXPECT_DOUBLE_EQ(colour->sigma, std::sqrt(7.0 / 4));
    EXPECT_DOUBLE_EQ(colour->bias, -0.25);
    EXPECT_DOUBLE_EQ(colour->deviation, std::sqrt(7.0 / 4 - 1.0 / 16));
    EXPECT_DOUBLE_EQ(colour->percentile_99, 2);
    EXPECT_DOUBLE_EQ(colour->largest, 2);
    EXPECT_DOUBLE_EQ(colour->relative_mean_square, (4 / 4.01 + 3 * 1 / 36.01) / 4);
    EXPECT_DOUBLE_EQ(colour->figure(), std::sqrt(7.0 / 4) / 5);
  }
}

TEST(FieldErrors, DoNotDependOnTheScaleOfWeightsAndScaleWithTheValues) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.5, 2);
  Values reference(100), judged(100), larger_reference(100), larger_judged(100);
  std::vector<double> weights(100), larger_weights(100);
  for (std::size_t i = 0; i < 100; ++i) {
    reference[i] = {uniform(random), uniform(random), uniform(random)};
    judged[i] = {uniform(random), uniform(random), uniform(random)};
    larger_reference[i] = 8.0 * reference[i];
    larger_judged[i] = 8.0 * judged[i];
    weights[i] = uniform(random);
    larger_weights[i] = 4 * weights[i];
  }
  const FieldErrors errors = compare_fields({judged}, {reference}, weights);
  const FieldErrors scaled = compare_fields({larger_judged}, {larger_reference}, larger_weights);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_DOUBLE_EQ(scaled.colours[c]->sigma, 8 * errors.colours[c]->sigma);
    EXPECT_DOUBLE_EQ(scaled.colours[c]->bias, 8 * errors.colours[c]->bias);
    EXPECT_DOUBLE_EQ(scaled.colours[c]->figure(), errors.colours[c]->figure());
    EXPECT_NEAR(std::pow(errors.colours[c]->bias, 2) + std::pow(errors.colours[c]->deviation, 2),
                std::pow(errors.colours[c]->sigma, 2), 1e-14);
  }
  EXPECT_EQ(errors.figure(), std::max({errors.colours[0]->figure(), errors.colours[1]->figure(),
                                       errors.colours[2]->figure()}));
}

TEST(FieldErrors, LeaveOutWhatHasNoWeight) {
  const Values reference{Rgb(2), Rgb(6), Rgb(100)}, judged{Rgb(4), Rgb(5), Rgb(0)};
  const FieldErrors errors = compare_fields({judged}, {reference}, std::vector<double>{1, 3, 0});
  EXPECT_DOUBLE_EQ(errors.colours[1]->mean, 5);
  EXPECT_DOUBLE_EQ(errors.colours[1]->largest, 2);
}

TEST(FieldErrors, LeaveOutColoursThatAreDarkInBoth) {
  const Values reference{Rgb(1, 0, 0), Rgb(1, 0, 0)}, judged{Rgb(1.5, 0, 0.5), Rgb(0.5, 0, 0)};
  const FieldErrors errors = compare_fields({judged}, {reference}, std::vector<double>{1, 1});
  EXPECT_DOUBLE_EQ(errors.colours[0]->figure(), 0.5);
  EXPECT_FALSE(errors.colours[1]);
  EXPECT_TRUE(std::isinf(errors.colours[2]->figure())) << "dark in B alone";
  EXPECT_TRUE(std::isinf(errors.figure()));
}

TEST(FieldErrors, OfOtherSizesAreADefect) {
  const Values one{Rgb(1)}, two{Rgb(1), Rgb(2)};
  const std::vector<double> weights{1, 1};
  EXPECT_THROW(static_cast<void>(compare_fields({one}, {two}, weights)), std::logic_error);
  EXPECT_THROW(static_cast<void>(compare_fields({two}, {one}, weights)), std::logic_error);
  EXPECT_THROW(static_cast<void>(compare_fields({two}, {two, two, two, one}, weights)), std::logic_error);
  EXPECT_THROW(static_cast<void>(compare_fields({two}, {two}, std::vector<double>{0, 0})), std::logic_error);
}

TEST(WeightedPercentile, IsTheLeastValueThatEnoughWeightDoesNotExceed) {
  std::vector<double> values(1000);
  for (std::size_t i = 0; i < 1000; ++i) values[i] = static_cast<double>((i * 7) % 1000 + 1);  // 1 to 1000
  const std::vector<double> equal(1000, 0.125);
  EXPECT_EQ(weighted_percentile(values, equal, 0.99), 990);
  EXPECT_EQ(weighted_percentile(values, equal, 0.5), 500);
  EXPECT_EQ(weighted_percentile(values, equal, 1), 1000);
  EXPECT_EQ(weighted_percentile(values, equal, 0), 1);
  // The largest has more than a hundredth of the weight, then less.
  EXPECT_EQ(weighted_percentile(std::vector<double>{1, 2}, std::vector<double>{98, 2}, 0.99), 2);
  EXPECT_EQ(weighted_percentile(std::vector<double>{1, 2}, std::vector<double>{199, 1}, 0.99), 1);
  EXPECT_EQ(weighted_percentile(std::vector<double>{1, 2, 9}, std::vector<double>{1, 1, 0}, 1), 2);
}

/// A reference of `truth` with independent Gaussian noise; the halves' standard deviation is sqrt(2) times
/// that of the whole, as of means of half as many samples.
struct NoisyField {
  Values values, error, half_a, half_b;

  NoisyField(const Values& truth, double noise, std::mt19937& random) {
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      // Some places are noisier than others.
      const double of_place = noise * (0.5 + static_cast<double>(i % 4) / 3);
      const auto half = [&](const Rgb& mean) {
        return mean + std::sqrt(2.0) * of_place * Rgb(normal(random), normal(random), normal(random));
      };
      half_a.push_back(half(truth[i]));
      half_b.push_back(half(truth[i]));
      values.push_back((half_a[i] + half_b[i]) / 2.0);
      error.emplace_back(of_place);
    }
  }
  [[nodiscard]] Field field() const { return {values, error, half_a, half_b}; }
};

struct Moments {
  double sum = 0, squares = 0;
  int count = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double deviation() const { return std::sqrt(squares / count - mean() * mean()); }
};

/// Over many draws of the noise: what is freed of noise has the right expectation, and the standard errors
/// that are told are those that are seen.
void expect_right_expectations(double true_error, double judged_noise, double reference_noise) {
  constexpr std::size_t kPlaces = 100;
  constexpr int kDraws = 2000;
  std::mt19937 random(2);
  Values truth(kPlaces), judged(kPlaces);
  std::vector<double> weights(kPlaces);
  double weight = 0, mean_square = 0, bias = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double n = static_cast<double>(i) / kPlaces;
    const double difference = true_error * (1 + std::sin(20 * n));
    truth[i] = Rgb(1 + n);
    judged[i] = truth[i] + difference;
    weights[i] = 1 + std::fmod(3 * n, 1);
    weight += weights[i];
    mean_square += weights[i] * difference * difference;
    bias += weights[i] * difference;
  }
  mean_square /= weight;
  bias /= weight;

  Moments square, square_error, biases, bias_error, deviation_square, plain;
  for (int draw = 0; draw < kDraws; ++draw) {
    const NoisyField reference(truth, reference_noise, random);
    const NoisyField noisy(judged, judged_noise, random);
    const FieldErrors errors =
        compare_fields(judged_noise > 0 ? noisy.field() : Field{judged}, reference.field(), weights);
    const ColourErrors& of = *errors.colours[1];
    ASSERT_TRUE(of.noise_free);
    square.add(of.noise_free->mean_square);
    square_error.add(of.noise_free->mean_square_error);
    deviation_square.add(of.noise_free->deviation_square);
    biases.add(of.bias);
    bias_error.add(of.noise_free->bias_error);
    plain.add(of.sigma * of.sigma);
  }
  const double draws = std::sqrt(kDraws);
  EXPECT_NEAR(square.mean(), mean_square, 4 * square.deviation() / draws);
  EXPECT_NEAR(deviation_square.mean(), mean_square - bias * bias, 4 * deviation_square.deviation() / draws);
  EXPECT_NEAR(biases.mean(), bias, 4 * biases.deviation() / draws);
  // A standard deviation of n draws is known to 1/sqrt(2 n): 1.6 %.
  EXPECT_NEAR(square_error.mean() / square.deviation(), 1, 0.05);
  EXPECT_NEAR(bias_error.mean() / biases.deviation(), 1, 0.05);
  // The plain sigma holds the noise: this is what is taken out.
  double noise_square = 0;
  for (std::size_t i = 0; i < kPlaces; ++i)
    noise_square += weights[i] * std::pow(0.5 + static_cast<double>(i % 4) / 3, 2);
  noise_square *= (std::pow(judged_noise, 2) + std::pow(reference_noise, 2)) / weight;
  EXPECT_NEAR(plain.mean(), mean_square + noise_square, 4 * plain.deviation() / draws);
}

TEST(NoiseFreeErrors, HaveTheRightExpectationWhereTheErrorIsAboveTheNoise) {
  expect_right_expectations(0.2, 0, 0.05);
}
TEST(NoiseFreeErrors, HaveTheRightExpectationWhereTheErrorIsBelowTheNoise) {
  expect_right_expectations(0.01, 0, 0.1);
}
TEST(NoiseFreeErrors, HaveTheRightExpectationWhereTheJudgedFieldIsNoisyToo) {
  expect_right_expectations(0.05, 0.1, 0.05);
}
TEST(NoiseFreeErrors, HaveTheRightExpectationWhereTwoReferencesAgree) {
  expect_right_expectations(0, 0.02, 0.05);
}

// With few places the noise of the bias is a large part of the deviation's.
TEST(NoiseFreeErrors, HaveADeviationWithoutTheNoiseOfTheBias) {
  constexpr int kDraws = 4000;
  std::mt19937 random(3);
  const Values truth(4, Rgb(1)), judged{Rgb(1.1), Rgb(0.9), Rgb(1.1), Rgb(0.9)};
  Moments deviation_square;
  for (int draw = 0; draw < kDraws; ++draw) {
    const NoisyField reference(truth, 0.1, random);
    const FieldErrors errors = compare_fields({judged}, reference.field(), std::vector<double>(4, 1.0));
    deviation_square.add(errors.colours[0]->noise_free->deviation_square);
  }
  EXPECT_NEAR(deviation_square.mean(), 0.01, 4 * deviation_square.deviation() / std::sqrt(kDraws));
}

TEST(NoiseFreeErrors, BelowZeroAreNoErrorWithAnUpperEnd) {
  NoiseFreeErrors errors;
  errors.mean_square = -1e-4;
  errors.mean_square_error = 5e-4;
  EXPECT_EQ(errors.sigma(), 0);
  EXPECT_EQ(errors.sigma_low(), 0);
  EXPECT_DOUBLE_EQ(errors.sigma_high(), std::sqrt(5e-4));
}

TEST(NoiseFreeErrors, AreTheFigure) {
  const Values reference{Rgb(1), Rgb(1)}, error{Rgb(0.1), Rgb(0.1)};
  const Values half_a{Rgb(1.1), Rgb(0.9)}, half_b{Rgb(0.9), Rgb(1.1)}, judged{Rgb(1.2), Rgb(1.2)};
  const FieldErrors errors =
      compare_fields({judged}, {reference, error, half_a, half_b}, std::vector<double>{1, 1});
  // (1.2 - 1.1)(1.2 - 0.9) = 0.03, while the plain square is 0.04.
  EXPECT_NEAR(errors.figure(), std::sqrt(0.03), 1e-15);
  EXPECT_NEAR(errors.colours[0]->sigma, 0.2, 1e-15);
  EXPECT_NEAR(errors.colours[0]->noise_free->reference_noise, 0.1, 1e-15);
  EXPECT_NEAR(errors.colours[0]->noise_free->bias_error, 0.1 / std::sqrt(2), 1e-15);
  EXPECT_NEAR(errors.colours[0]->quadratic_mean, std::sqrt(0.99), 1e-15);
}

}  // namespace
}  // namespace fluxel
