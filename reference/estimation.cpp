#include "reference/estimation.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>

#include "core/sampling.hpp"
#include "reference/path_batch.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kHalf = kRandomisations / 2;

std::size_t half_of(std::size_t randomisation) { return randomisation / kHalf; }

/// Numbers of samples after which the variance is kept, and their places in the list of them.
std::uint32_t next_kept(std::uint32_t samples) {
  return samples < kMinSamples ? kMinSamples : 2 * std::bit_floor(samples);
}
bool is_kept(std::uint32_t samples) { return samples >= kMinSamples && std::has_single_bit(samples); }
std::size_t place_of(std::uint32_t kept) {
  return static_cast<std::size_t>(std::bit_width(kept) - std::bit_width(kMinSamples));
}

}  // namespace

Estimation::Estimation(const Sensors& sensors, const BlockedSensors& mine, std::uint64_t seed,
                       Sampling sampling, DeviceBatch* device)
    : sensors_(sensors),
      mine_(mine),
      seed_(random_bits(seed)),
      sampling_(sampling),
      device_(device),
      samples_(mine.ends.size(), HalfSamples{}),
      sums_(mine.sensors.size(), Sums{}),
      light_(mine.ends.size()) {}

void Estimation::add(std::span<const HalfSamples> until, const std::function<void(double)>& done) {
  double work = 0, ready = 0;
  for (std::size_t block = 0; block < samples_.size(); ++block)
    for (std::size_t half = 0; half < 2; ++half)
      work += sample_count(block, samples_[block][half], until[block][half]);
  while (true) {
    const std::vector<HalfSamples> next = next_stage(until);
    if (next == samples_) return;
    add_stage(next, [&](double samples) {
      ready += samples;
      done(ready / (kHalf * work));
    });
    for (std::size_t block = 0; block < next.size(); ++block)
      for (std::size_t half = 0; half < 2; ++half) {
        const bool is_new = samples_[block][half] != next[block][half];
        samples_[block][half] = next[block][half];
        if (is_new && is_kept(next[block][half])) keep_spread(block, half);
      }
  }
}

/// Where all randomisations of a block stop next: at what is asked for, or where its variance is kept.
std::vector<HalfSamples> Estimation::next_stage(std::span<const HalfSamples> until) const {
  std::vector<HalfSamples> next = samples_;
  for (std::size_t block = 0; block < next.size(); ++block)
    for (std::size_t half = 0; half < 2; ++half)
      next[block][half] =
          std::max(next[block][half], std::min(until[block][half], next_kept(next[block][half])));
  return next;
}

/// `count` is told of samples that have been added, one call at a time.
void Estimation::add_stage(std::span<const HalfSamples> next, const std::function<void(double)>& count) {
  if (device_ != nullptr) {
    add_by_device(next, count);
    return;
  }
  // Randomisations are shared out too, as there may be few sensors; more than a few hundred parts gain
  // nothing.
  constexpr std::size_t kMaxParts = 256, kLargestPart = 4;
  const std::size_t all = next.size() * kRandomisations;
  const std::size_t grain = std::clamp<std::size_t>(all / kMaxParts, 1, kLargestPart);
  std::mutex counting;
  const auto add_range = [&](const tbb::blocked_range<std::size_t>& range) {
    std::uint64_t rays = 0;
    double samples = 0;
    for (std::size_t at = range.begin(); at < range.end(); ++at) {
      const std::size_t block = at / kRandomisations, r = at % kRandomisations;
      const std::uint32_t first = samples_[block][half_of(r)], last = next[block][half_of(r)];
      PathBatch batch(sensors_);
      add_samples(block, r, {first, last}, batch);
      batch.trace();
      rays += batch.rays();
      samples += sample_count(block, first, last);
    }
    if (samples == 0) return;
    const std::lock_guard lock(counting);
    rays_ += rays;
    count(samples);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all, grain), add_range, tbb::simple_partitioner());
}

/// Of all blocks and randomisations in turn, so that few sensors fill a device as well. `count` is told of
/// samples that wait for the device, too.
void Estimation::add_by_device(std::span<const HalfSamples> next, const std::function<void(double)>& count) {
  const std::uint64_t before = device_->rays();
  for (std::size_t block = 0; block < next.size(); ++block)
    for (std::size_t r = 0; r < kRandomisations; ++r) {
      const std::uint32_t first = samples_[block][half_of(r)], last = next[block][half_of(r)];
      add_samples(block, r, {first, last}, *device_);
      if (last > first) count(sample_count(block, first, last));
    }
  device_->trace();
  rays_ += device_->rays() - before;
}

/// What `batch` collects of a randomisation: each sensor's samples ascending, so that sums are the same
/// whatever it holds.
template <class Batch>
void Estimation::add_samples(std::size_t block, std::size_t randomisation, const SampleRange& range,
                             Batch& batch) {
  for (std::size_t k = first_of(block); k < mine_.ends[block]; ++k) {
    const std::size_t sensor = mine_.sensors[k];
    if (sensors_.weight(sensor) == 0) continue;
    const std::uint64_t seed = random_bits(seed_ + sensor * kRandomisations + randomisation);
    for (std::uint32_t sample = range.first; sample < range.last; ++sample)
      batch.add({sensor, OwenSobol(seed, sample)}, sums_[k][randomisation]);
  }
}

/// Of one randomisation.
double Estimation::sample_count(std::size_t block, std::uint32_t first, std::uint32_t last) const {
  return last > first ? static_cast<double>(mine_.ends[block] - first_of(block)) * (last - first) : 0;
}

/// As the means of a half's randomisations tell.
void Estimation::keep_spread(std::size_t block, std::size_t half) {
  const double samples = samples_[block][half];
  Rgb light(0), squares(0);
  double sensors = 0;
  for (std::size_t k = first_of(block); k < mine_.ends[block]; ++k) {
    const double weight = sensors_.weight(mine_.sensors[k]);
    if (weight == 0) continue;
    ++sensors;
    const auto of_half = std::span(sums_[k]).subspan(half * kHalf, kHalf);
    Rgb mean(0);
    for (const PathSum& one : of_half) mean += one.sum / (kHalf * samples);
    for (const PathSum& one : of_half)
      squares += weight * (one.sum / samples - mean) * (one.sum / samples - mean);
    light += weight * mean;
  }
  const std::size_t place = place_of(samples_[block][half]);
  if (place == 0) light_[block][half] = light;
  if (place >= variances_.size()) variances_.resize(place + 1);
  variances_[place].resize(samples_.size(), {Rgb(0), Rgb(0)});
  if (sensors > 0) variances_[place][block][half] = squares * (samples / ((kHalf - 1) * sensors));
}

SensorEstimate Estimation::estimate(std::size_t k, const ErrorRule& rule) const {
  if (sensors_.weight(mine_.sensors[k]) == 0) return {};
  const HalfSamples& samples = samples_[block_of(k)];
  std::array<Rgb, 2> halves{Rgb(0), Rgb(0)};
  for (std::size_t r = 0; r < kRandomisations; ++r)
    halves[half_of(r)] += sums_[k][r].sum * (1.0 / (kHalf * static_cast<double>(samples[half_of(r)])));
  // Halves count the same whatever their samples are. A half has many where the other has met much light:
  // weighted by samples, the other would count least where it is high, and the mean be too low.
  const Rgb mean = 0.5 * (halves[0] + halves[1]);
  // Halves of different samples spread differently, each about its own mean: a degree of freedom less.
  const bool even = sampling_ == Sampling::even;
  Rgb squares(0);
  for (std::size_t r = 0; r < kRandomisations; ++r) {
    const Rgb of_one = sums_[k][r].sum / static_cast<double>(samples[half_of(r)]);
    const Rgb difference = of_one - (even ? mean : halves[half_of(r)]);
    squares += difference * difference;
  }
  const int freedom = kRandomisations - (even ? 1 : 2);
  PathSum all;
  for (const PathSum& of_one : sums_[k]) all.add(of_one);
  const double contributions = all.contributions();
  const double paths = kHalf * (static_cast<double>(samples[0]) + samples[1]);
  const Rgb error = contributions > 0 ? glm::sqrt(squares * (rule.of_each ? 1 + 1 / contributions : 1.0) /
                                                  static_cast<double>(kRandomisations * freedom))
                                      : rule.contribution / paths;
  return {mean, rule.selection * error, halves[0], halves[1]};
}

SensorSums Estimation::sums(std::size_t block, const ErrorRule& rule) const {
  SensorSums sums;
  for (std::size_t k = first_of(block); k < mine_.ends[block]; ++k) {
    const double weight = sensors_.weight(mine_.sensors[k]);
    if (weight == 0) continue;
    const SensorEstimate of = estimate(k, rule);
    const Rgb squared_error = of.error * of.error;
    sums.weight += weight;
    sums.mean += weight * of.mean;
    sums.square += weight * of.half_a * of.half_b;
    sums.squared_error += weight * squared_error;
    sums.fourth_power += weight * squared_error * (weight * squared_error);
  }
  return sums;
}

PathSum Estimation::found(std::size_t block) const {
  PathSum all;
  for (std::size_t k = first_of(block); k < mine_.ends[block]; ++k)
    for (const PathSum& of_one : sums_[k]) all.add(of_one);
  return all;
}

BlockSpread Estimation::spread(std::size_t block, std::uint32_t pilot) const {
  BlockSpread spread;
  for (std::size_t k = first_of(block); k < mine_.ends[block]; ++k)
    if (sensors_.weight(mine_.sensors[k]) != 0) ++spread.sensors;
  spread.light = light_[block];
  spread.variance = variances_[place_of(pilot)][block];
  return spread;
}

std::size_t Estimation::block_of(std::size_t k) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(mine_.ends, k) - mine_.ends.begin());
}

}  // namespace fluxel
