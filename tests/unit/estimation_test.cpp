#include "reference/estimation.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

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

void ignore(std::size_t /*ready*/) {}

/// By one thread, as sensors from a list need it.
void add_in_order(Estimation& estimation, std::uint32_t first, std::uint32_t last) {
  tbb::task_arena(1).execute([&] { estimation.add(first, last, ignore); });
}

TEST(Estimation, TheErrorIsThatOfTheRandomisationsMeans) {
  // Two samples of each of 16 randomisations: their means are 1, 2, ..., 16.
  std::vector<double> values;
  for (int r = 1; r <= kRandomisations; ++r) values.insert(values.end(), {r - 0.5, r + 0.5});
  const Listed sensors({values});
  const std::vector<std::size_t> mine{0};
  Estimation estimation(sensors, mine, 1);
  add_in_order(estimation, 0, 2);
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
  EXPECT_EQ(estimation.rays(), 64u);
}

TEST(Estimation, SumsGoByWeightAndLeaveOutWhatWeighsNothing) {
  const std::vector<double> of_second(kRandomisations, 3);
  std::vector<double> of_third(kRandomisations, 0);
  for (std::size_t r = 1; r < of_third.size(); r += 2) of_third[r] = 1;
  const Listed sensors({{}, of_second, of_third});
  const std::vector<std::size_t> mine{0, 1, 2};
  Estimation estimation(sensors, mine, 1);
  add_in_order(estimation, 0, 1);
  EXPECT_EQ(sensors.asked(), (std::vector<std::size_t>{0, 16, 16}));
  const SensorSums all = estimation.sums(0, 3);
  EXPECT_DOUBLE_EQ(all.weight, 2 + 3);
  EXPECT_DOUBLE_EQ(all.mean.r, 2 * 3 + 3 * 0.5);
  EXPECT_DOUBLE_EQ(all.squared_error.r, 3 * 16 * 0.25 / 240);
  const SensorSums last = estimation.sums(2, 3);
  EXPECT_DOUBLE_EQ(last.weight, 3);
  EXPECT_DOUBLE_EQ(last.mean.r, 1.5);
  EXPECT_EQ(estimation.estimate(0).mean, Rgb(0));
}

TEST(Estimation, ValuesDependOnSensorSeedAndSamplesAlone) {
  const Shown sensors;
  std::vector<std::size_t> everything(sensors.size());
  std::iota(everything.begin(), everything.end(), std::size_t{0});
  const std::vector<std::size_t> some{3, 17, 39};
  Estimation all(sensors, everything, 5), part(sensors, some, 5), other(sensors, some, 6);
  tbb::task_arena(2).execute([&] { all.add(0, 24, ignore); });
  std::vector<std::size_t> told;
  part.add(0, 8, [&](std::size_t ready) { told.push_back(ready); });
  part.add(8, 24, ignore);
  other.add(0, 24, ignore);
  EXPECT_EQ(told.back(), some.size());
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

// Were randomisations or sensors to share numbers, means would agree better than they are right, and the
// error of one sensor or of the mean of all would be too small.
TEST(Estimation, TheErrorIsHonest) {
  constexpr int kSeeds = 40;
  const Shown sensors;
  std::vector<std::size_t> everything(sensors.size());
  std::iota(everything.begin(), everything.end(), std::size_t{0});
  double squares = 0, stated = 0, squares_of_means = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Estimation estimation(sensors, everything, seed);
    estimation.add(0, 5, ignore);
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
