#include "reference/estimation.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/sampling.hpp"
#include "reference/path_batch.hpp"

namespace fluxel {

Estimation::Estimation(const Sensors& sensors, const std::vector<std::size_t>& mine, std::uint64_t seed)
    : sensors_(sensors), mine_(mine), seed_(random_bits(seed)), sums_(mine.size(), Sums{}) {}

void Estimation::add(std::uint32_t first, std::uint32_t last, const std::function<void(std::size_t)>& done) {
  const std::size_t blocks = (mine_.size() + kSensorBlock - 1) / kSensorBlock;
  std::mutex counting;
  std::size_t ready = 0;
  // Randomisations are shared out too, as there may be few sensors.
  tbb::parallel_for(std::size_t{0}, blocks * kRandomisations, [&](std::size_t at) {
    const std::size_t from = at / kRandomisations * kSensorBlock;
    const std::size_t to = std::min(from + kSensorBlock, mine_.size());
    const std::uint64_t rays = add_block(from, to, at % kRandomisations, first, last);
    const std::lock_guard lock(counting);
    rays_ += rays;
    ready += to - from;
    done(ready / kRandomisations);
  });
  samples_ = last;
}

std::uint64_t Estimation::add_block(std::size_t from, std::size_t to, std::size_t r, std::uint32_t first,
                                    std::uint32_t last) {
  PathBatch batch(sensors_);
  for (std::size_t k = from; k < to; ++k) {
    if (sensors_.weight(mine_[k]) == 0) continue;
    const std::uint64_t seed = random_bits(seed_ + mine_[k] * kRandomisations + r);
    for (std::uint32_t sample = first; sample < last; ++sample)
      batch.add({mine_[k], OwenSobol(seed, sample)}, sums_[k][r]);
  }
  batch.trace();
  return batch.rays();
}

SensorEstimate Estimation::estimate(std::size_t k) const {
  constexpr auto kHalf = kRandomisations / 2;
  SensorEstimate estimate;
  const double of_half = 1.0 / (kHalf * static_cast<double>(samples_));
  for (std::size_t r = 0; r < kRandomisations; ++r)
    (r < kHalf ? estimate.half_a : estimate.half_b) += sums_[k][r] * of_half;
  estimate.mean = 0.5 * (estimate.half_a + estimate.half_b);
  Rgb squares(0);
  for (const Rgb& sum : sums_[k]) {
    const Rgb difference = sum / static_cast<double>(samples_) - estimate.mean;
    squares += difference * difference;
  }
  estimate.error = glm::sqrt(squares / static_cast<double>(kRandomisations * (kRandomisations - 1)));
  return estimate;
}

SensorSums Estimation::sums(std::size_t first, std::size_t last) const {
  SensorSums sums;
  for (std::size_t k = first; k < last; ++k) {
    const double weight = sensors_.weight(mine_[k]);
    const SensorEstimate of = estimate(k);
    sums.weight += weight;
    sums.mean += weight * of.mean;
    sums.squared_error += weight * of.error * of.error;
  }
  return sums;
}

}  // namespace fluxel
