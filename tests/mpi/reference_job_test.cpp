#include "mpi_master/steps/reference_job.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
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
  return measure(world(), sensors, limits, 9, threads, progress);
}

/// All sensors by this rank alone, with as many samples.
void expect_as_alone(const ReferenceResult& result, const Sensors& sensors) {
  std::vector<std::size_t> all(sensors.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Estimation alone(sensors, all, 9);
  alone.add(0, result.samples, [](std::size_t) {});
  ASSERT_EQ(result.sensors.size(), world().is_root() ? all.size() : 0);
  for (std::size_t k = 0; k < result.sensors.size(); ++k) {
    const SensorEstimate expected = alone.estimate(k);
    ASSERT_EQ(result.sensors[k].mean, expected.mean) << k;
    ASSERT_EQ(result.sensors[k].error, expected.error) << k;
    ASSERT_EQ(result.sensors[k].half_a, expected.half_a) << k;
    ASSERT_EQ(result.sensors[k].half_b, expected.half_b) << k;
  }
  EXPECT_EQ(result.rays, alone.rays());
  const SensorSums sums = alone.sums(0, all.size());
  if (sums.weight == 0) return;
  const Rgb mean = sums.mean / sums.weight;
  for (int c = 0; c < kChannels; ++c) {
    EXPECT_NEAR(result.mean[c], mean[c], 1e-12 * mean[c]);
    EXPECT_NEAR(result.relative_error[c], std::sqrt(sums.squared_error[c] / sums.weight) / mean[c], 1e-12);
  }
}

// One sensor, one block and a bit, blocks enough for seven ranks with a last one that is not full.
TEST(ReferenceJob, EqualsOneRankAlone) {
  for (const std::size_t size : {1, 65, 1000}) {
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
  limits.target_error = 2e-3;
  const ReferenceResult result = measured(sensors, limits);
  expect_as_alone(result, sensors);
  EXPECT_TRUE(result.reached);
  EXPECT_GT(result.samples, kMinSamples);
  const Rgb& error = result.relative_error;
  EXPECT_LE(std::max({error.r, error.g, error.b}), 2e-3);
  EXPECT_EQ(error.r, 0) << "this channel has no noise";
  limits.target_error = 4e-3;
  EXPECT_LT(measured(sensors, limits).samples, result.samples);
  EXPECT_EQ(measured(sensors, {}).samples, measured(sensors, {kReferenceError, {}, {}}).samples);
}

TEST(ReferenceJob, TheFirstLimitCounts) {
  const Numbers sensors(200);
  const ReferenceResult few = measured(sensors, {1e-9, {}, 50000});
  EXPECT_FALSE(few.reached);
  EXPECT_LE(few.rays, 50000u);
  expect_as_alone(few, sensors);
  const ReferenceResult least = measured(sensors, {{}, 1e-9, {}});
  EXPECT_EQ(least.samples, kMinSamples) << "and no fewer";
  expect_as_alone(least, sensors);
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
  for (const ReferenceLimits& limits : {ReferenceLimits{}, ReferenceLimits{{}, {}, 1000}}) {
    const ReferenceResult result = measured(Weightless(), limits);
    EXPECT_EQ(result.sensors.size(), world().is_root() ? 70u : 0u);
    EXPECT_EQ(result.rays, 0u);
    EXPECT_EQ(result.mean, Rgb(0));
    EXPECT_TRUE(result.reached);
  }
}

}  // namespace
}  // namespace fluxel::test
