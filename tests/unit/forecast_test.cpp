// Forecasts of phases whose end is known: synthetic series.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "metrics/phase_record.hpp"

namespace fluxel {
namespace {

/// Samples of a phase, `count` at equal distances, from 1 of them to all; the last has done `work` at
/// `seconds`.
template <class Done, class Error>
std::vector<PhaseSample> series(double seconds, int count, Done done, Error error) {
  std::vector<PhaseSample> samples;
  for (int k = 1; k <= count; ++k) {
    const double t = seconds * k / count, work = done(t);
    samples.push_back({t, work, error(work)});
  }
  return samples;
}

const auto kNoError = [](double) { return PhaseSample::kUnknown; };

TEST(Forecast, NothingIsForecastBeforeAnythingIsDone) {
  EXPECT_TRUE(std::isinf(forecast_by_work({}, 10)));
  const std::vector<PhaseSample> idle{{1, 0}, {2, 0}};
  EXPECT_TRUE(std::isinf(forecast_by_work(idle, 10)));
  EXPECT_TRUE(std::isinf(forecast_by_error({}, ErrorLaw::sampling, 0.1)));
  EXPECT_TRUE(std::isinf(forecast_by_error(idle, ErrorLaw::sampling, 0.1)));
  EXPECT_TRUE(std::isinf(forecast_by_error(idle, ErrorLaw::geometric, 0.1)));
}

TEST(Forecast, EvenWorkEndsInProportion) {
  const auto samples = series(
      10, 20, [](double t) { return 3 * t; }, kNoError);
  EXPECT_NEAR(forecast_by_work(samples, 300), 100, 1e-9);
  EXPECT_NEAR(forecast_by_work(std::span(samples).first(1), 300), 100, 1e-9);
  EXPECT_EQ(forecast_by_work(samples, 30), 10);
}

TEST(Forecast, TheTimeBeforeTheFirstSampleIsStartUp) {
  // 5 s until the first unit, then 1 s a unit.
  const std::vector<PhaseSample> samples{{5, 1}, {6, 2}, {7, 3}};
  EXPECT_NEAR(forecast_by_work(samples, 20), 24, 1e-9);
}

TEST(Forecast, RestoredWorkIsNeitherDoneNorToDo) {
  const auto samples = series(
      10, 20, [](double t) { return 900 + t; }, kNoError);
  EXPECT_NEAR(forecast_by_work(samples, 1000, 900), 100, 1e-9);
  // The only sample says how fast work is by what was done here.
  EXPECT_NEAR(forecast_by_work(std::span(samples).last(1), 1000, 900), 100, 1e-9);
}

TEST(Forecast, AChangeOfPaceIsFollowed) {
  // At t = 20 the machine becomes half as fast; then 100 - 20 = 80 units need 160 s more: the end is at 180
  // s.
  const auto work = [](double t) { return t < 20 ? t : 20 + (t - 20) / 2; };
  const double soon = forecast_by_work(series(30, 60, work, kNoError), 100);
  const double later = forecast_by_work(series(60, 60, work, kNoError), 100);
  EXPECT_GT(soon, 120);
  EXPECT_LT(soon, 180);
  EXPECT_NEAR(later, 180, 18);
  EXPECT_GT(later, soon);
}

TEST(Forecast, MonteCarloEndsWhereTheSquareRootSays) {
  const auto samples = series(
      10, 50, [](double t) { return 1e6 * t; }, [](double n) { return 5 / std::sqrt(n); });
  const double error = samples.back().error;
  EXPECT_NEAR(work_for_error(samples, ErrorLaw::sampling, error / 10), 1e9, 1e3);
  EXPECT_NEAR(forecast_by_error(samples, ErrorLaw::sampling, error / 10), 1000, 1e-3);
  // Two samples are enough for it.
  EXPECT_NEAR(forecast_by_error(std::span(samples).first(2), ErrorLaw::sampling, error / 10), 1000, 1e-3);
}

TEST(Forecast, AReachedTargetIsNow) {
  const auto samples = series(
      10, 50, [](double t) { return t; }, [](double n) { return 1 / n; });
  for (const ErrorLaw law : {ErrorLaw::sampling, ErrorLaw::power, ErrorLaw::geometric})
    EXPECT_EQ(forecast_by_error(samples, law, 0.2), 10);
}

TEST(Forecast, EvenPointsEndEarlierThanNoise) {
  // The parts of a squared error, together what a tenth of the run shows.
  for (const auto& [noise, even] : {std::pair(1.0, 0.0), std::pair(0.0, 1.0), std::pair(0.02, 1.0)}) {
    const auto error = [noise = noise, even = even](double n) { return std::sqrt(noise / n + even / n / n); };
    const auto samples = series(
        10, 100, [](double t) { return t; }, error);
    EXPECT_NEAR(forecast_by_error(samples, ErrorLaw::sampling, error(100)), 100, 1e-6) << noise;
  }
}

TEST(Forecast, PhotonsOfASequenceEndWhereTheirPowerSays) {
  const auto by_power = [](double power, double start) {
    return series(
        10, 60, [](double t) { return t; },
        [=](double n) { return std::pow(n, -power) * (n < start ? 3 : 1); });
  };
  // The usual power is not bent, errors of less than a quarter of the work do not count.
  EXPECT_NEAR(work_for_error(by_power(0.54, 2.4), ErrorLaw::power, std::pow(100, -0.54)), 100, 1e-6);
  // Another one is found, as far as the samples tell: they are over 1.4 e-folds.
  const double seen = work_for_error(by_power(0.62, 0), ErrorLaw::power, std::pow(100, -0.62));
  EXPECT_GT(seen, 100);
  EXPECT_NEAR(seen, 100, 8);
  // Neither slower than random numbers nor quicker than even points over a smooth function.
  for (const auto& [power, least] : {std::pair(0.1, 0.5), std::pair(3.0, 1.0)}) {
    const auto samples = by_power(power, 0);
    const double error = samples.back().error;
    EXPECT_NEAR(work_for_error(samples, ErrorLaw::power, error / 1e4) /
                    work_for_error(samples, ErrorLaw::power, error / 1e3),
                std::pow(10, 1 / least), 1e-6 * std::pow(10, 1 / least))
        << power;
  }
  // One error is enough.
  EXPECT_NEAR(work_for_error(std::vector<PhaseSample>{{1, 100, 0.1}}, ErrorLaw::power, 0.01),
              100 * std::pow(10, 1 / 0.54), 1e-6);
}

TEST(Forecast, NoErrorFallsQuickerThanEvenPointsOrSlowerThanNoise) {
  for (const auto& [power, ratio] : {std::pair(3.0, 10.0), std::pair(0.1, 100.0)}) {
    const auto samples = series(
        10, 100, [](double t) { return t; }, [power = power](double n) { return std::pow(n, -power); });
    const double error = samples.back().error;
    EXPECT_NEAR(work_for_error(samples, ErrorLaw::sampling, error / 1e4) /
                    work_for_error(samples, ErrorLaw::sampling, error / 1e3),
                ratio, 1e-6 * ratio)
        << power;
  }
}

TEST(Forecast, NoiseOfErrorsDoesNotBendTheSquareRoot) {
  // A standard error from 16 randomisations, of several independent quantities: 5 % of noise, fresh in each.
  const double target = std::sqrt(1.0 / 1000);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.05);
    const auto samples = series(
        100, 200, [](double t) { return t; },
        [&](double n) { return std::exp(noise(random)) / std::sqrt(n); });
    // Errors of 5 % are of 10 % in time; the mean of the last half is far better than each.
    EXPECT_NEAR(forecast_by_error(samples, ErrorLaw::sampling, target), 1000, 150) << seed;
  }
}

TEST(Forecast, NoiseThatStaysDoesNotBendTheSquareRoot) {
  // Means of n normal numbers of 16 randomisations: the errors of successive samples are those of growing
  // sums.
  const double target = 1 / std::sqrt(16.0 * 10'000);
  int near = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> number;
    constexpr int kQuantities = 32;
    std::vector<std::array<double, 16>> sums(kQuantities);
    std::vector<PhaseSample> samples;
    for (int n = 1; n <= 1000; ++n) {
      double variance = 0;
      for (auto& of_quantity : sums) {
        double mean = 0, square = 0;
        for (double& sum : of_quantity) {
          sum += number(random);
          mean += sum / n / 16;
          square += sum / n * sum / n / 16;
        }
        variance += (square - mean * mean) / 15 / kQuantities;
      }
      if (n % 10 == 0) samples.push_back({0.01 * n, 16.0 * n, std::sqrt(variance)});
    }
    const double end = forecast_by_error(samples, ErrorLaw::sampling, target);
    // A tenth of the run, 10 s of 100.
    EXPECT_NEAR(end, 100, 30) << seed;
    if (std::abs(end - 100) < 10) ++near;
  }
  EXPECT_GE(near, 14);
}

TEST(Forecast, StartUpDoesNotCount) {
  // The first hundredth of the work is ten times worse than the law.
  const auto samples = series(
      10, 200, [](double t) { return t; }, [](double n) { return (n < 0.1 ? 10 : 1) / n; });
  EXPECT_NEAR(forecast_by_error(samples, ErrorLaw::sampling, 0.01), 100, 1);
}

TEST(Forecast, IterationsEndWhereTheirRateSays) {
  // 3 s of start-up, 2 s an iteration, each takes the error by half.
  std::vector<PhaseSample> samples;
  for (int k = 1; k <= 5; ++k) samples.push_back({3 + 2.0 * k, 1.0 * k, std::pow(0.5, k)});
  EXPECT_NEAR(work_for_error(samples, ErrorLaw::geometric, std::pow(0.5, 20)), 20, 1e-9);
  EXPECT_NEAR(forecast_by_error(samples, ErrorLaw::geometric, std::pow(0.5, 20)), 43, 1e-9);
  EXPECT_NEAR(forecast_by_error(std::span(samples).first(2), ErrorLaw::geometric, std::pow(0.5, 20)), 43,
              1e-9);
  EXPECT_TRUE(std::isinf(forecast_by_error(std::span(samples).first(1), ErrorLaw::geometric, 1e-6)));
  // There are no parts of iterations, and two more may follow the last.
  EXPECT_NEAR(work_for_error(samples, ErrorLaw::geometric, std::pow(0.5, 19.2)), 20, 1e-9);
  EXPECT_NEAR(forecast_by_error(samples, ErrorLaw::geometric, std::pow(0.5, 20), 2), 47, 1e-9);
}

TEST(Forecast, NoiseOfIterationsIsSmoothed) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.1);
    const auto samples = series(
        30, 30, [](double t) { return t; },
        [&](double n) { return std::exp(noise(random)) * std::pow(0.8, n); });
    EXPECT_NEAR(work_for_error(samples, ErrorLaw::geometric, std::pow(0.8, 60)), 60, 4) << seed;
  }
}

TEST(Forecast, AGrowingErrorHasNoEnd) {
  const auto samples = series(
      10, 10, [](double t) { return t; }, [](double n) { return n; });
  EXPECT_TRUE(std::isinf(forecast_by_error(samples, ErrorLaw::geometric, 0.1)));
}

TEST(PhaseRecord, StaysShortHoweverLongThePhase) {
  PhaseRecord record("long");
  constexpr int kUpdates = 1'000'000;
  for (int k = 1; k <= kUpdates; ++k) record.add(0.002 * k, k, kUpdates);
  record.finish(2001);
  EXPECT_LE(record.samples().size(), PhaseRecord::kMaxSamples);
  EXPECT_GE(record.samples().size(), PhaseRecord::kMaxSamples / 2);
  for (std::size_t k = 1; k < record.samples().size(); ++k) {
    EXPECT_GT(record.samples()[k].seconds, record.samples()[k - 1].seconds);
    EXPECT_GT(record.samples()[k].done, record.samples()[k - 1].done);
    EXPECT_NEAR(record.samples()[k].forecast, 2000, 2) << k;
  }
  EXPECT_TRUE(record.finished());
  EXPECT_EQ(record.samples().back().seconds, 2001);
  EXPECT_EQ(record.samples().back().done, kUpdates);
}

TEST(PhaseRecord, FollowsATargetThatMoves) {
  PhaseRecord record("solve");
  EXPECT_FALSE(record.has_errors());
  for (int k = 1; k <= 6; ++k)
    EXPECT_TRUE(record.add_error(k, {1.0 * k, std::pow(0.1, k), 1e-4, ErrorLaw::geometric}));
  EXPECT_TRUE(record.has_errors());
  EXPECT_EQ(record.forecast(), 6);
  record.add_error(7, {7, 1e-7, 1e-12, ErrorLaw::geometric});
  EXPECT_NEAR(record.forecast(), 12, 1e-6);
  EXPECT_EQ(record.samples().back().target, 1e-12);
}

TEST(PhaseRecord, WithoutUpdatesHasNoSamples) {
  PhaseRecord record("image");
  record.finish(3);
  EXPECT_TRUE(record.samples().empty());
  EXPECT_TRUE(std::isinf(record.forecast()));
}

}  // namespace
}  // namespace fluxel
