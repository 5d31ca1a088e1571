#include "metrics/audit_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace fluxel {
namespace {

constexpr std::size_t kRandomisations = 16;

/// Differences of this many places, of true values drawn around `bias`, with noise that the places of one
/// randomisation share in part.
class Drawn {
 public:
  explicit Drawn(unsigned seed) : random_(seed) {}

  std::vector<double> draw(std::size_t places, double bias, double deviation, double noise) {
    std::normal_distribution<double> normal;
    std::vector<double> shared(kRandomisations);
    for (double& of : shared) of = noise * normal(random_);
    std::vector<double> differences;
    for (std::size_t place = 0; place < places; ++place) {
      const double truth = bias + deviation * normal(random_);
      for (std::size_t r = 0; r < kRandomisations; ++r)
        differences.push_back(truth + 0.1 * shared[r] + noise * normal(random_));
    }
    return differences;
  }

 private:
  std::mt19937 random_;
};

std::vector<std::uint32_t> first_of(std::size_t places) {
  std::vector<std::uint32_t> all(places);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

TEST(AuditStatistics, DifferencesWithoutNoiseAreFoundAsTheyAre) {
  std::vector<double> differences;
  for (const double truth : {1.0, 2.0, 6.0})
    for (std::size_t r = 0; r < kRandomisations; ++r) differences.push_back(truth);
  const AuditSamples samples{differences, kRandomisations};
  const AuditedValue bias = audited_bias(samples, first_of(3));
  EXPECT_DOUBLE_EQ(bias.value, 3);
  EXPECT_NEAR(bias.of_paths, 0, 1e-12);
  EXPECT_NEAR(bias.of_places, std::sqrt(14.0 / 3 / 3), 1e-12) << "the variance between places, over them";
  const AuditedValue square = audited_square(samples);
  EXPECT_NEAR(square.value, 41.0 / 3, 1e-12);
  EXPECT_NEAR(square.of_paths, 0, 1e-12);
  const std::vector<std::uint32_t> last{2};
  EXPECT_DOUBLE_EQ(audited_bias(samples, last).value, 6);
}

// In 2,000 trials 95 % have a standard error of 0.5 %.
TEST(AuditStatistics, NineteenOfTwentyIntervalsHoldTheTruth) {
  Drawn drawn(1);
  constexpr int kTrials = 2000;
  constexpr std::size_t kPlaces = 64;
  const double width = interval_width(0.95, 1, kRandomisations);
  int biases = 0, squares = 0, noise_alone = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<double> of = drawn.draw(kPlaces, 0.5, 1, 2);
    const AuditSamples samples{of, kRandomisations};
    const AuditedValue bias = audited_bias(samples, first_of(kPlaces));
    if (std::abs(bias.value - 0.5) < width * std::hypot(bias.of_paths, bias.of_places)) ++biases;
    const AuditedValue square = audited_square(samples);
    if (std::abs(square.value - 1.25) < width * std::hypot(square.of_paths, square.of_places)) ++squares;
    const std::vector<double> nothing = drawn.draw(kPlaces, 0, 0, 2);
    const AuditedValue none = audited_square({nothing, kRandomisations});
    if (none.value < width * std::hypot(none.of_paths, none.of_places)) ++noise_alone;
  }
  EXPECT_NEAR(biases / double{kTrials}, 0.95, 0.02);
  EXPECT_NEAR(squares / double{kTrials}, 0.95, 0.03);
  EXPECT_GT(noise_alone / double{kTrials}, 0.93) << "noise is no error";
}

TEST(AuditStatistics, WhereThereIsNoiseAloneTheSquareIsNothingOnAverage) {
  Drawn drawn(2);
  double sum = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial)
    sum += audited_square({drawn.draw(16, 0, 0, 1), kRandomisations}).value / kTrials;
  // Of one trial about sqrt(2 / 16) / 16.
  EXPECT_NEAR(sum, 0, 5e-3);
}

TEST(AuditStatistics, WidthsAreStudents) {
  EXPECT_NEAR(interval_width(0.95, 1, 16), 2.1314, 1e-4);
  EXPECT_NEAR(interval_width(0.95, 1, 3), 4.3027, 1e-4);
  EXPECT_NEAR(interval_width(0.99, 1, 16), 2.9467, 1e-4);
  EXPECT_NEAR(interval_width(0.95, 5, 16), 2.9467, 1e-4) << "five at 1 % are 5 % together";
}

}  // namespace
}  // namespace fluxel
