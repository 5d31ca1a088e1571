#include "reference/wave.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/sampled_sensors.hpp"

namespace fluxel {
namespace {

/// A sensor returns two of its numbers.
class Numbers final : public SampledSensors {
 public:
  explicit Numbers(std::size_t size) : size_(size) {}
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }
  [[nodiscard]] Rgb sample(std::size_t /*sensor*/, OwenSobol numbers, std::uint64_t& rays) const override {
    ++rays;
    const auto of = numbers.next();
    return {of[0], of[1], 0};
  }

 private:
  std::size_t size_;
};

TEST(Wave, APartIsAsInTheWhole) {
  const Numbers sensors(100);
  std::vector<Rgb> whole(100), part(30);
  EXPECT_EQ(measure_wave(sensors, {5, 3}, 0, whole), 300u);
  EXPECT_EQ(measure_wave(sensors, {5, 3}, 60, part), 90u);
  EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin() + 60));
  std::vector<Rgb> other(100);
  measure_wave(sensors, {6, 3}, 0, other);
  EXPECT_NE(other[0], whole[0]) << "another seed";
}

// The mean of 64 random numbers is off by 1 / sqrt(12 * 64), of even ones by about 1 / 64 of that root.
TEST(Wave, NeighboursAreEvenTogether) {
  const Numbers sensors(1024);
  double squares = 0;
  constexpr int kWaves = 20;
  for (std::uint64_t seed = 0; seed < kWaves; ++seed) {
    std::vector<Rgb> means(1024);
    measure_wave(sensors, {seed, 1}, 0, means);
    for (std::size_t first = 0; first < means.size(); first += 64) {
      double sum = 0;
      for (std::size_t k = first; k < first + 64; ++k) sum += means[k].r / 64;
      squares += (sum - 0.5) * (sum - 0.5) / (16 * kWaves);
    }
  }
  EXPECT_LT(std::sqrt(squares), 0.2 / std::sqrt(12.0 * 64));
}

}  // namespace
}  // namespace fluxel
