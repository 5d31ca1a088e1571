#include "mpi_master/steps/wave_job.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/sampled_sensors.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

class Numbers final : public SampledSensors {
 public:
  explicit Numbers(std::size_t size) : size_(size) {}
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }
  [[nodiscard]] Rgb sample(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const override {
    rays += 1 + sensor % 2;
    const auto of = numbers.next();
    return {static_cast<double>(sensor), of[0], of[1] * of[2]};
  }

 private:
  std::size_t size_;
};

// Fewer sensors than ranks, and as many as no number of ranks divides.
TEST(WaveJob, EqualsOneRankAlone) {
  for (const std::size_t size : {1U, 5U, 1009U}) {
    const Numbers sensors(size);
    std::vector<Rgb> alone(size);
    const std::uint64_t rays = measure_wave(sensors, {3, 4}, 0, alone);
    for (const int threads : {1, 2}) {
      const MeasuredWave found = trace_wave(world(), sensors, {3, 4}, threads);
      EXPECT_EQ(found.means, alone);
      EXPECT_EQ(found.rays, rays);
    }
  }
}

}  // namespace
}  // namespace fluxel::test
