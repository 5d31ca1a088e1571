#include "mpi_master/steps/reference_job.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <optional>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/sampled_sensors.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

/// Sensors of one dimension of the numbers each, some of which weigh nothing.
class Numbers final : public SampledSensors {
 public:
  explicit Numbers(std::size_t size) : size_(size) {}

  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] double weight(std::size_t sensor) const override {
    return sensor % 5 == 3 ? 0 : 1 + 0.1 * static_cast<double>(sensor % 7);
  }
  [[nodiscard]] Rgb sample(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const override {
    rays += 1 + sensor % 2;
    const auto [x, y, z, w] = numbers.next();
    return {static_cast<double>(sensor + 1), x, y * z};
  }

 private:
  std::size_t size_;
};

ReferenceResult measured(const Sensors& sensors, const ReferenceLimits& limits, int threads = 1) {
  SilentProgress progress;
  return measure(world(), sensors, 0, {limits, Sampling::even, 9}, threads, progress);
}

/// Samples dealt to blocks, of sensors in rows.
ReferenceResult dealt(const Communicator& communicator, const Sensors& sensors, std::size_t columns,
                      const ReferenceLimits& limits, int threads = 1) {
  SilentProgress progress;
  return measure(communicator, sensors, columns, {limits, Sampling::blocks, 9}, threads, progress);
}

/// What ends at the first look at which its error is small enough states a little more than that.
void expect_error(const Rgb& stated, const Rgb& found) {
  for (int c = 0; c < kChannels; ++c) {
    EXPECT_GE(stated[c], (1 - 1e-9) * found[c]);
    EXPECT_LE(stated[c], 1.09 * found[c]);
  }
}

/// All sensors by this rank alone, with as many samples.
void expect_as_alone(const ReferenceResult& result, const Sensors& sensors) {
  std::vector<std::size_t> all(sensors.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const BlockedSensors blocked{all, {all.size()}};
  Estimation alone(sensors, blocked, 9, Sampling::even);
  alone.add(std::vector{HalfSamples{result.samples, result.samples}}, [](double) {});
  ASSERT_EQ(result.sensors.size(), world().is_root() ? all.size() : 0);
  for (std::size_t k = 0; k < result.sensors.size(); ++k) {
    const SensorEstimate expected = alone.estimate(k);
    ASSERT_EQ(result.sensors[k].mean, expected.mean) << k;
    expect_error(result.sensors[k].error, expected.error);
    ASSERT_EQ(result.sensors[k].half_a, expected.half_a) << k;
    ASSERT_EQ(result.sensors[k].half_b, expected.half_b) << k;
  }
  EXPECT_EQ(result.rays, alone.rays());
  const SensorSums sums = alone.sums(0);
  if (sums.weight == 0) return;
  const Rgb mean = sums.mean / sums.weight;
  for (int c = 0; c < kChannels; ++c) {
    EXPECT_NEAR(result.mean[c], mean[c], 1e-12 * mean[c]);
  }
  expect_error(result.relative_error, glm::sqrt(sums.squared_error / sums.weight) / mean);
}

// One sensor, one block and a bit, blocks enough for seven ranks with a last one that is not full.
ReferenceLimits to_error(std::optional<double> target, std::optional<double> seconds = {},
                         std::optional<std::uint64_t> rays = {}) {
  ReferenceLimits limits;
  limits.error.target_error = target;
  limits.seconds = seconds;
  limits.rays = rays;
  return limits;
}

TEST(ReferenceJob, EqualsOneRankAlone) {
  for (const std::size_t size : {1U, 65U, 1000U}) {
    const Numbers sensors(size);
    for (const int threads : {1, 2}) {
      SCOPED_TRACE(size);
      ReferenceLimits limits;
      limits.rays = 100000;
      const ReferenceResult result = measured(sensors, limits, threads);
      expect_as_alone(result, sensors);
      EXPECT_TRUE(result.reached);
      EXPECT_FALSE(result.stopped);
      EXPECT_LE(result.rays, 100000u);
      EXPECT_GT(result.rays, 80000u);
    }
  }
}

TEST(ReferenceJob, EndsAtTheTargetError) {
  const Numbers sensors(200);
  ReferenceLimits limits;
  limits.error.target_error = 2e-3;
  const ReferenceResult result = measured(sensors, limits);
  expect_as_alone(result, sensors);
  EXPECT_TRUE(result.reached);
  EXPECT_EQ(result.ending, ReferenceEnding::target);
  EXPECT_GT(result.samples, kMinSamples);
  const Rgb& error = result.relative_error;
  EXPECT_LE(std::max({error.r, error.g, error.b}), 2e-3);
  EXPECT_EQ(error.r, 0) << "this channel has no noise";
  limits.error.target_error = 4e-3;
  EXPECT_LT(measured(sensors, limits).samples, result.samples);
  EXPECT_EQ(measured(sensors, {}).samples, measured(sensors, to_error(kReferenceError)).samples);
}

// What is asked for without the mean is asked for over it, times that.
TEST(ReferenceJob, EndsAtTheAbsoluteError) {
  const Numbers sensors(200);
  const ReferenceResult relative = measured(sensors, to_error(4e-3));
  const Rgb errors = relative.relative_error * glm::abs(relative.mean);
  ReferenceLimits limits;
  limits.error.absolute_error = std::max({errors.r, errors.g, errors.b});
  const ReferenceResult absolute = measured(sensors, limits);
  EXPECT_TRUE(absolute.reached);
  EXPECT_LE(absolute.samples, relative.samples);
  EXPECT_GT(2 * absolute.samples, relative.samples);
}

TEST(ReferenceJob, TheFirstLimitCounts) {
  const Numbers sensors(200);
  const ReferenceResult few = measured(sensors, to_error(1e-9, {}, 50000));
  EXPECT_FALSE(few.reached);
  EXPECT_EQ(few.ending, ReferenceEnding::rays);
  EXPECT_LE(few.rays, 50000u);
  expect_as_alone(few, sensors);
  const ReferenceResult least = measured(sensors, to_error({}, 1e-9));
  EXPECT_EQ(least.samples, kMinSamples) << "and no fewer";
  EXPECT_EQ(least.ending, ReferenceEnding::time);
  expect_as_alone(least, sensors);
}

/// Sensors of which few see a lamp, and those through chinks: the share of paths that find it falls with the
/// sensor's number.
class Chinks final : public SampledSensors {
 public:
  explicit Chinks(std::size_t size) : size_(size) {}

  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] double weight(std::size_t sensor) const override { return sensor % 9 == 4 ? 0 : 1; }
  [[nodiscard]] Rgb sample(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const override {
    rays += 2;
    const auto [x, y, z, w] = numbers.next();
    const bool sees = sensor < size_ / 8 && x < 0.5 / static_cast<double>(1 + sensor % 16);
    return sees ? Rgb(1 + y, 1, z) : Rgb(0.01);
  }

 private:
  std::size_t size_;
};

// Pixels, in squares that do not fit; one pixel; and what has no rows. Fewer sensors than ranks, too.
TEST(ReferenceJob, DealsTheSameOnAnyNumberOfRanksAndThreads) {
  const Communicator alone = world().split(world().rank()).ordered_by_hosts(0);
  for (const auto& [size, columns] :
       {std::pair<std::size_t, std::size_t>{40 * 37, 40}, {1, 1}, {65, 0}, {3, 3}}) {
    SCOPED_TRACE(size);
    const Chinks sensors(size);
    ReferenceLimits limits;
    limits.rays = 3000 * size;
    const ReferenceResult expected = dealt(alone, sensors, columns, limits);
    const ReferenceResult result = dealt(world(), sensors, columns, limits, 2);
    EXPECT_EQ(result.rays, expected.rays);
    EXPECT_LE(result.rays, 1.1 * static_cast<double>(*limits.rays));
    EXPECT_GE(result.rays, 0.8 * static_cast<double>(*limits.rays));
    EXPECT_EQ(result.relative_error, expected.relative_error);
    EXPECT_EQ(result.least_samples, expected.least_samples);
    EXPECT_EQ(result.most_samples, expected.most_samples);
    EXPECT_TRUE(size < 1000 || result.most_samples > 4 * result.least_samples);
    ASSERT_EQ(result.sensors.size(), world().is_root() ? size : 0);
    for (std::size_t k = 0; k < result.sensors.size(); ++k) {
      ASSERT_EQ(result.sensors[k].mean, expected.sensors[k].mean) << k;
      ASSERT_EQ(result.sensors[k].error, expected.sensors[k].error) << k;
      ASSERT_EQ(result.sensors[k].half_a, expected.sensors[k].half_a) << k;
      ASSERT_EQ(result.sensors[k].half_b, expected.sensors[k].half_b) << k;
    }
  }
}

TEST(ReferenceJob, DealtSamplesAreFewerToTheSameError) {
  const Chinks sensors(64 * 64);
  ReferenceLimits limits;
  limits.error.target_error = 0.02;
  const ReferenceResult even = measured(sensors, limits), result = dealt(world(), sensors, 64, limits);
  EXPECT_TRUE(result.reached);
  EXPECT_LT(static_cast<double>(result.rays), 0.5 * static_cast<double>(even.rays));
  EXPECT_LE(result.least_samples, result.samples);
  EXPECT_GE(result.most_samples, result.samples);
  EXPECT_EQ(even.least_samples, even.samples);
  EXPECT_EQ(even.most_samples, even.samples);
}

/// Sensors that no light comes to.
class Dark : public SampledSensors {
 public:
  [[nodiscard]] bool has_light() const override { return false; }

 protected:
  [[nodiscard]] std::size_t size() const override { return 300; }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }
  [[nodiscard]] Rgb sample(std::size_t /*sensor*/, OwenSobol /*numbers*/,
                           std::uint64_t& rays) const override {
    ++rays;
    return Rgb(0);
  }
};

TEST(ReferenceJob, DealsWhereNothingIsSeenAndWhereRaysAreFew) {
  const ReferenceResult dark = dealt(world(), Dark(), 20, {});
  EXPECT_TRUE(dark.reached);
  EXPECT_EQ(dark.mean, Rgb(0));
  EXPECT_EQ(dark.samples, kBelievedDealtSamples);
  const ReferenceResult by_rays = dealt(world(), Dark(), 20, {{}, {}, 300 * kRandomisations * 40});
  EXPECT_EQ(by_rays.least_samples, by_rays.most_samples) << "as even as can be";
  EXPECT_EQ(by_rays.samples, 40u);
  const ReferenceResult few = dealt(world(), Dark(), 20, {{}, {}, 1});
  EXPECT_EQ(few.samples, kMinSamples) << "and no fewer";
}

// Light that there is and that no path finds leaves the error unknown, never 0.
TEST(ReferenceJob, WhatIsNotFoundIsNotKnown) {
  class Unlucky final : public Dark {
    [[nodiscard]] bool has_light() const override { return true; }
    [[nodiscard]] bool may_show_nothing() const override { return false; }
    // Of one ray alone a path would have met nothing.
    [[nodiscard]] Rgb sample(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const override {
      ++rays;
      return Dark::sample(sensor, numbers, rays);
    }
  };
  for (const Sampling sampling : {Sampling::even, Sampling::blocks}) {
    SilentProgress progress;
    const ReferenceResult result =
        measure(world(), Unlucky(), 20, {to_error(0.05), sampling, 9}, 1, progress);
    EXPECT_FALSE(result.reached);
    EXPECT_EQ(result.ending, ReferenceEnding::in_vain);
    EXPECT_TRUE(std::isinf(result.relative_error.r));
    for (const SensorEstimate& of : result.sensors) EXPECT_TRUE(std::isinf(of.error.g));
  }
}

/// One meter that every 3,000th path finds the light of.
class Pinhole final : public SampledSensors {
  [[nodiscard]] std::size_t size() const override { return 1; }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }
  [[nodiscard]] bool may_show_nothing() const override { return false; }
  [[nodiscard]] Rgb sample(std::size_t /*sensor*/, OwenSobol numbers, std::uint64_t& rays) const override {
    rays += 2;
    const auto [x, y, z, w] = numbers.next();
    return x < 1.0 / 30 && y > 0.4 && y < 0.41 ? Rgb(3000) : Rgb(0);
  }
};

// Of 60 runs to 5 %, by Student's t, 40 lie within one stated error, and all but one or two within three.
TEST(ReferenceJob, ErrorsOfWhatIsSeldomFoundHold) {
  int within = 0, beyond = 0;
  constexpr int kSeeds = 60;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    SilentProgress progress;
    const PathGoal goal{to_error(0.05), Sampling::blocks, static_cast<std::uint64_t>(seed)};
    const ReferenceResult result = measure(world(), Pinhole(), 1, goal, 1, progress);
    EXPECT_TRUE(result.reached);
    if (!world().is_root()) continue;
    EXPECT_GT(result.sensors[0].error.r, 0);
    const double off = std::abs(result.sensors[0].mean.r - 1) / result.sensors[0].error.r;
    within += off <= 1 ? 1 : 0;
    beyond += off > 3 ? 1 : 0;
  }
  if (!world().is_root()) return;
  EXPECT_NEAR(within, 0.667 * kSeeds, 11) << "three standard errors";
  EXPECT_LE(beyond, 3);
}

TEST(ReferenceJob, NothingToMeasure) {
  class Weightless final : public SampledSensors {
    [[nodiscard]] std::size_t size() const override { return 70; }
    [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 0; }
    [[nodiscard]] Rgb sample(std::size_t /*sensor*/, OwenSobol /*numbers*/,
                             std::uint64_t& /*rays*/) const override {
      throw std::logic_error("it weighs nothing");
    }
  };
  for (const ReferenceLimits& limits : {ReferenceLimits{}, to_error({}, {}, 1000)}) {
    const ReferenceResult result = measured(Weightless(), limits);
    EXPECT_EQ(result.sensors.size(), world().is_root() ? 70u : 0u);
    EXPECT_EQ(result.rays, 0u);
    EXPECT_EQ(result.mean, Rgb(0));
    EXPECT_TRUE(result.reached);
    EXPECT_EQ(dealt(world(), Weightless(), 10, limits).rays, 0u);
  }
}

}  // namespace
}  // namespace fluxel::test
