#include "reference/estimation.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/sampling.hpp"

namespace fluxel {

Estimation::Estimation(const Sensors& sensors, const std::vector<std::size_t>& mine, std::uint64_t seed)
    : sensors_(sensors), mine_(mine), seed_(random_bits(seed)), sums_(mine.size(), Sums{}) {}

void Estimation::add(std::uint32_t first, std::uint32_t last, const std::function<void(std::size_t)>& done) {
  // Randomisations are shared out too, as there may be few sensors; more than a few hundred parts gain
  // nothing.
  constexpr std::size_t kMaxParts = 256, kLargestPart = 256;
  const std::size_t all = mine_.size() * kRandomisations;
  const std::size_t grain = std::clamp<std::size_t>(all / kMaxParts, 1, kLargestPart);
  std::mutex counting;
  std::size_t ready = 0;
  const auto add_range = [&](const tbb::blocked_range<std::size_t>& range) {
    std::uint64_t rays = 0;
    for (std::size_t at = range.begin(); at < range.end(); ++at) {
      const std::size_t k = at / kRandomisations, r = at % kRandomisations;
      if (sensors_.weight(mine_[k]) == 0) continue;
      const std::uint64_t seed = random_bits(seed_ + mine_[k] * kRandomisations + r);
      for (std::uint32_t sample = first; sample < last; ++sample)
        sums_[k][r] += sensors_.measure(mine_[k], OwenSobol(seed, sample), rays);
    }
    const std::lock_guard lock(counting);
    rays_ += rays;
    ready += range.size();
    done(ready / kRandomisations);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all, grain), add_range, tbb::simple_partitioner());
  samples_ = last;
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
