#include "reference/estimation.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "tests/sampled_sensors.hpp"

namespace fluxel {
namespace {

/// Sensors whose paths bring what a table says, in the order in which they are asked for: by one thread.
class Listed final : public SampledSensors {
 public:
  explicit Listed(std::vector<std::vector<double>> values)
      : values_(std::move(values)), asked_(values_.size()) {}

  [[nodiscard]] const std::vector<std::size_t>& asked() const { return asked_; }

  [[nodiscard]] std::size_t size() const override { return values_.size(); }
  [[nodiscard]] double weight(std::size_t sensor) const override {
    return values_[sensor].empty() ? 0 : static_cast<double>(sensor + 1);
  }
  [[nodiscard]] Rgb sample(std::size_t sensor, OwenSobol /*numbers*/, std::uint64_t& rays) const override {
    rays += 2;
    const double value = values_[sensor].at(asked_[sensor]++);
    return {value, 2 * value, 5};
  }

 private:
  std::vector<std::vector<double>> values_;
  mutable std::vector<std::size_t> asked_;
};

/// Sensors that show the numbers that they are given.
class Shown final : public SampledSensors {
 public:
  [[nodiscard]] std::size_t size() const override { return 40; }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }
  [[nodiscard]] Rgb sample(std::size_t /*sensor*/, OwenSobol numbers, std::uint64_t& rays) const override {
    ++rays;
    const auto [x, y, z, w] = numbers.next();
    return {x, y, z};
  }
};

void ignore(double /*part*/) {}

/// Each in a block of its own.
BlockedSensors each_in_a_block(const std::vector<std::size_t>& sensors) {
  BlockedSensors blocked{sensors, {}};
  for (std::size_t k = 1; k <= sensors.size(); ++k) blocked.ends.push_back(k);
  return blocked;
}

std::vector<HalfSamples> of_all(const BlockedSensors& sensors, std::uint32_t samples) {
  return std::vector<HalfSamples>(sensors.ends.size(), HalfSamples{samples, samples});
}

/// By one thread, as sensors from a list need it.
void add_in_order(Estimation& estimation, const std::vector<HalfSamples>& until) {
  tbb::task_arena(1).execute([&] { estimation.add(until, ignore); });
}

TEST(Estimation, TheErrorIsThatOfTheRandomisationsMeans) {
  // Two samples of each of 16 randomisations: their means are 1, 2, ..., 16.
  std::vector<double> values;
  for (int r = 1; r <= kRandomisations; ++r) values.insert(values.end(), {r - 0.5, r + 0.5});
  const Listed sensors({values});
  const BlockedSensors mine = each_in_a_block({0});
  Estimation estimation(sensors, mine, 1, Sampling::even);
  add_in_order(estimation, of_all(mine, 2));
  const SensorEstimate found = estimation.estimate(0);
  EXPECT_DOUBLE_EQ(found.mean.r, 8.5);
  EXPECT_DOUBLE_EQ(found.mean.g, 17);
  EXPECT_DOUBLE_EQ(found.half_a.r, 4.5);
  EXPECT_DOUBLE_EQ(found.half_b.r, 12.5);
  // The sum of (r - 8.5)^2 is 340, over 16 * 15.
  EXPECT_DOUBLE_EQ(found.error.r, std::sqrt(340.0 / 240));
  EXPECT_DOUBLE_EQ(found.error.g, 2 * std::sqrt(340.0 / 240));
  EXPECT_DOUBLE_EQ(found.mean.b, 5);
  EXPECT_EQ(found.error.b, 0);
  // Looked at alone it has that of one contribution more; of 32 values from 0.5 to 16.5 with the mean 8.5
  // and the mean square 93.75 there are 24.66.
  const double contributions = 32 * 8.5 * 8.5 / 93.75;
  EXPECT_NEAR(estimation.estimate(0, {true}).error.r, std::sqrt(340.0 / 240 * (1 + 1 / contributions)), 1e-2);
  EXPECT_EQ(estimation.rays(), 64u);
}

TEST(Estimation, SumsGoByWeightAndLeaveOutWhatWeighsNothing) {
  const std::vector<double> of_second(kRandomisations, 3);
  std::vector<double> of_third(kRandomisations, 0);
  for (std::size_t r = 1; r < of_third.size(); r += 2) of_third[r] = 1;
  const Listed sensors({{}, of_second, of_third});
  const BlockedSensors mine{{0, 1, 2}, {2, 3}};
  Estimation estimation(sensors, mine, 1, Sampling::even);
  add_in_order(estimation, of_all(mine, 1));
  EXPECT_EQ(sensors.asked(), (std::vector<std::size_t>{0, 16, 16}));
  const SensorSums first = estimation.sums(0);
  EXPECT_DOUBLE_EQ(first.weight, 2);
  EXPECT_DOUBLE_EQ(first.mean.r, 2 * 3);
  EXPECT_EQ(first.squared_error.r, 0);
  const SensorSums last = estimation.sums(1);
  EXPECT_DOUBLE_EQ(last.squared_error.r, 3 * 16 * 0.25 / 240);
  EXPECT_DOUBLE_EQ(last.weight, 3);
  EXPECT_DOUBLE_EQ(last.mean.r, 1.5);
  EXPECT_EQ(estimation.estimate(0).mean, Rgb(0));
}

TEST(Estimation, ValuesDependOnSensorSeedAndSamplesAlone) {
  const Shown sensors;
  std::vector<std::size_t> everything(sensors.size());
  std::iota(everything.begin(), everything.end(), std::size_t{0});
  const std::vector<std::size_t> some{3, 17, 39};
  const BlockedSensors blocked{everything, {7, everything.size()}}, few = each_in_a_block(some);
  Estimation all(sensors, blocked, 5, Sampling::even), part(sensors, few, 5, Sampling::even),
      other(sensors, few, 6, Sampling::even);
  tbb::task_arena(2).execute([&] { all.add(of_all(blocked, 24), ignore); });
  std::vector<double> told;
  part.add(of_all(few, 8), [&](double ready) { told.push_back(ready); });
  part.add(of_all(few, 24), ignore);
  other.add(of_all(few, 24), ignore);
  EXPECT_DOUBLE_EQ(told.back(), 1);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  std::set<double> means;
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(part.estimate(k).mean, all.estimate(some[k]).mean);
    EXPECT_EQ(part.estimate(k).error, all.estimate(some[k]).error);
    EXPECT_NE(part.estimate(k).mean, other.estimate(k).mean);
    means.insert(part.estimate(k).mean.r);
  }
  EXPECT_EQ(means.size(), some.size()) << "sensors have random numbers of their own";
  EXPECT_EQ(all.rays(), 40u * kRandomisations * 24);
}

// A block's halves may have samples of their own: each is then a mean of its own, and counts as much.
TEST(Estimation, HalvesOfDifferentSamplesCountTheSame) {
  std::vector<double> values;
  // Twice a half's mean of 1 from 4 samples, and 3 from 8, give or take 1.
  for (int r = 0; r < kRandomisations; ++r)
    values.insert(values.end(), 4, (r < 8 ? 1.0 : 3.0) + (r % 2 == 0 ? 1 : -1));
  for (int r = 8; r < kRandomisations; ++r) values.insert(values.end(), 4, 3.0 + (r % 2 == 0 ? 1 : -1));
  const Listed sensors({values});
  const BlockedSensors mine = each_in_a_block({0});
  Estimation estimation(sensors, mine, 1, Sampling::blocks);
  add_in_order(estimation, {HalfSamples{4, 8}});
  const SensorEstimate found = estimation.estimate(0);
  EXPECT_DOUBLE_EQ(found.half_a.r, 1);
  EXPECT_DOUBLE_EQ(found.half_b.r, 3);
  EXPECT_DOUBLE_EQ(found.mean.r, 2);
  // Squared errors of the halves are 8 / (8 * 7); that of the mean is a quarter of both.
  EXPECT_DOUBLE_EQ(found.error.r, std::sqrt(2 * (8.0 / 56) / 4));
  EXPECT_EQ(estimation.rays(), 2u * 8 * (4 + 8));
}

// Whatever is measured later, the first samples tell the same.
TEST(Estimation, SpreadsAreThoseOfTheFirstSamples) {
  const Shown sensors;
  std::vector<std::size_t> everything(sensors.size());
  std::iota(everything.begin(), everything.end(), std::size_t{0});
  const BlockedSensors blocked{everything, {20, 40}};
  Estimation early(sensors, blocked, 3, Sampling::blocks), late(sensors, blocked, 3, Sampling::blocks);
  early.add(of_all(blocked, 8), ignore);
  late.add(std::vector{HalfSamples{100, 9}, HalfSamples{8, 1000}}, ignore);
  for (std::size_t block = 0; block < 2; ++block)
    for (const std::uint32_t pilot : {4u, 8u}) {
      const BlockSpread first = early.spread(block, pilot), then = late.spread(block, pilot);
      EXPECT_EQ(first.sensors, 20u);
      for (std::size_t half = 0; half < 2; ++half) {
        EXPECT_EQ(first.light[half], then.light[half]);
        EXPECT_EQ(first.variance[half], then.variance[half]);
      }
      // Uniform numbers vary by 1/12, and less in the mean of even ones.
      EXPECT_GT(first.variance[0].r, 0);
      EXPECT_LT(first.variance[0].r, 1.0 / 12);
    }
}

// Were randomisations or sensors to share numbers, means would agree better than they are right, and the
// error of one sensor or of the mean of all would be too small.
TEST(Estimation, TheErrorIsHonest) {
  constexpr int kSeeds = 40;
  const Shown sensors;
  std::vector<std::size_t> everything(sensors.size());
  std::iota(everything.begin(), everything.end(), std::size_t{0});
  const BlockedSensors blocked = each_in_a_block(everything);
  double squares = 0, stated = 0, squares_of_means = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Estimation estimation(sensors, blocked, seed, Sampling::even);
    estimation.add(of_all(blocked, 5), ignore);
    double deviation = 0;
    for (std::size_t k = 0; k < everything.size(); ++k) {
      const SensorEstimate found = estimation.estimate(k);
      deviation += found.mean.r - 0.5;
      squares += (found.mean.r - 0.5) * (found.mean.r - 0.5);
      stated += found.error.r * found.error.r;
    }
    squares_of_means += deviation * deviation;
  }
  // All are sums of independent squares, with relative deviations of sqrt(2 / n) and less.
  const double values = kSeeds * static_cast<double>(everything.size());
  EXPECT_NEAR(squares / stated, 1, 4 * std::sqrt((2 + 2.0 / 15) / values));
  EXPECT_NEAR(squares_of_means / stated, 1, 4 * std::sqrt(2.0 / kSeeds));
}

}  // namespace
}  // namespace fluxel
