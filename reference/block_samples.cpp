#include "reference/block_samples.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <vector>

namespace fluxel {

namespace {

/// The next number that is a quarter of a power of two times a whole one.
std::uint32_t next_even(std::uint32_t samples) {
  const std::uint32_t step = std::max(std::bit_floor(samples) / 4, 1u);
  const std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  return samples > most - step ? most : samples - samples % step + step;
}

/// A step that a block may take.
struct Step {
  double gain;  ///< squared error that it takes away, for each sample
  std::uint32_t from, to;
  std::size_t block;

  /// Of no gain: to whom has least.
  bool operator<(const Step& other) const {
    if (gain != other.gain) return gain < other.gain;
    return from != other.from ? from > other.from : block > other.block;
  }
};

/// Of `variance`, which the first samples have: with even points the squared error falls with samples to a
/// power of 1 where light varies everywhere, of 1.7 where it varies at edges alone. 1.5 serves both.
Step step_of(std::size_t block, double variance, std::uint32_t from) {
  const std::uint32_t to = next_even(from);
  const auto left = [](double samples) { return 1 / (samples * std::sqrt(samples)); };
  return {variance * (left(from) - left(to)) / std::max(to - from, 1u), from, to, block};
}

/// The channel whose error over its mean is largest, which is what a measurement states, as a half tells of
/// the other.
int worst_channel(std::span<const BlockSpread> spreads, std::size_t half,
                  std::span<const HalfSamples> samples) {
  Rgb light(0), squares(0);
  for (std::size_t block = 0; block < spreads.size(); ++block) {
    light += spreads[block].light[half];
    squares += spreads[block].variance[half] *
               (static_cast<double>(spreads[block].sensors) / samples[block][1 - half]);
  }
  const auto relative = [&](int c) { return light[c] != 0 ? squares[c] / (light[c] * light[c]) : 0; };
  int worst = 0;
  for (int c = 1; c < kChannels; ++c)
    if (relative(c) > relative(worst)) worst = c;
  return worst;
}

void deal_half(std::uint32_t mean, std::span<const BlockSpread> spreads, std::size_t half,
               std::span<HalfSamples> samples) {
  const std::uint32_t least = least_samples(mean);
  for (HalfSamples& of_block : samples) of_block[half] = std::max(of_block[half], least);
  const int channel = worst_channel(spreads, 1 - half, samples);
  const auto next_step = [&](std::size_t block, std::uint32_t from) {
    return step_of(block, spreads[block].variance[1 - half][channel], from);
  };
  std::uint64_t sensors = 0, dealt = 0;
  std::vector<Step> steps;
  steps.reserve(spreads.size());
  for (std::size_t block = 0; block < spreads.size(); ++block) {
    const std::uint32_t of_block = samples[block][half];
    if (spreads[block].sensors == 0) continue;
    sensors += spreads[block].sensors;
    dealt += spreads[block].sensors * of_block;
    steps.push_back(next_step(block, of_block));
  }
  std::uint64_t left = sensors * mean - std::min(sensors * mean, dealt);
  std::priority_queue<Step> queue(std::less<Step>(), std::move(steps));
  while (!queue.empty()) {
    const Step step = queue.top();
    queue.pop();
    if (step.from == step.to) continue;  // it has all that can be counted
    const std::uint64_t width = spreads[step.block].sensors;
    const auto taken = static_cast<std::uint32_t>(std::min<std::uint64_t>(step.to - step.from, left / width));
    samples[step.block][half] = step.from + taken;
    if (taken < step.to - step.from) return;
    left -= taken * width;
    queue.push(next_step(step.block, step.to));
  }
}

}  // namespace

std::uint32_t least_samples(std::uint32_t mean) { return std::max(std::min(mean, kMinSamples), mean / 4); }

std::uint32_t pilot_samples(std::uint32_t mean) { return std::bit_floor(least_samples(mean)); }

void deal_samples(std::uint32_t mean, std::span<const BlockSpread> spreads, std::span<HalfSamples> samples) {
  for (std::size_t half = 0; half < 2; ++half) deal_half(mean, spreads, half, samples);
}

}  // namespace fluxel
