#include "mpi_master/steps/reference_job.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <limits>

#include "core/options.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/root_clock.hpp"
#include "mpi_master/steps/forecast.hpp"
#include "mpi_master/steps/ray_devices.hpp"
#include "reference/cuda/same_path.hpp"
#include "solver/channels.hpp"

namespace fluxel {

namespace {

/// Of a pass; a processor traces some 3e6 a second.
constexpr double kMaxRaysAPass = 1e8;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// What every rank has made of each of its blocks, in the order of the blocks.
template <class T>
std::vector<T> in_block_order(const Communicator& communicator, std::span<const T> mine, std::size_t blocks) {
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::vector<T> gathered = communicator.all_gather(mine);
  std::vector<T> all(blocks);
  std::size_t at = 0;
  for (std::size_t rank = 0; rank < ranks; ++rank)
    for (std::size_t block = rank; block < blocks; block += ranks) all[block] = gathered[at++];
  return all;
}

/// As it is sent to the root.
struct SentEstimate {
  std::uint64_t sensor = 0;
  SensorEstimate estimate;
};

/// Collective: the estimates of all sensors on the root, nothing elsewhere.
std::vector<SensorEstimate> estimates_on_root(const Communicator& communicator, const Estimation& estimation,
                                              std::span<const std::size_t> mine, std::size_t sensors,
                                              const ErrorRule& rule) {
  constexpr int kTag = 16;
  constexpr std::size_t kMaxInAMessage = std::size_t{1} << 20;
  std::vector<SensorEstimate> all(communicator.is_root() ? sensors : 0);
  if (communicator.is_root()) {
    for (std::size_t k = 0; k < mine.size(); ++k) all[mine[k]] = estimation.estimate(k, rule);
  } else {
    for (std::size_t first = 0; first < mine.size(); first += kMaxInAMessage) {
      std::vector<SentEstimate> some;
      for (std::size_t k = first; k < std::min(first + kMaxInAMessage, mine.size()); ++k)
        some.push_back({mine[k], estimation.estimate(k, rule)});
      const auto bytes = std::as_bytes(std::span(some));
      communicator.send(0, kTag, Bytes(bytes.begin(), bytes.end()));
    }
  }
  communicator.receive_all([&](const Message& message) {
    for (std::size_t at = 0; at < message.data.size(); at += sizeof(SentEstimate)) {
      SentEstimate sent;
      std::memcpy(&sent, message.data.data() + at, sizeof(SentEstimate));
      all[sent.sensor] = sent.estimate;
    }
  });
  return all;
}

/// What all paths have found, in the order of the blocks.
PathSum found_by_all(const Communicator& communicator, const Estimation& estimation, std::size_t mine,
                     std::size_t blocks) {
  std::vector<PathSum> parts;
  for (std::size_t block = 0; block < mine; ++block) parts.push_back(estimation.found(block));
  PathSum all;
  for (const PathSum& part : in_block_order(communicator, std::span<const PathSum>(parts), blocks))
    all.add(part);
  return all;
}

/// Sums over all sensors, in the order of the blocks.
SensorSums sum_all(const Communicator& communicator, const Estimation& estimation, std::size_t mine,
                   std::size_t blocks, const ErrorRule& rule) {
  std::vector<SensorSums> parts;
  for (std::size_t block = 0; block < mine; ++block) parts.push_back(estimation.sums(block, rule));
  SensorSums all;
  for (const SensorSums& part : in_block_order(communicator, std::span<const SensorSums>(parts), blocks)) {
    all.weight += part.weight;
    all.mean += part.mean;
    all.square += part.square;
    all.squared_error += part.squared_error;
    all.fourth_power += part.fourth_power;
  }
  return all;
}

/// Of each block: where the samples go. The same on all ranks.
class BlockDeal {
 public:
  BlockDeal(const Communicator& communicator, std::size_t blocks, Sampling sampling)
      : communicator_(communicator), sampling_(sampling), samples_(blocks, HalfSamples{}) {}

  /// Collective: so many in the mean from now on, where `mean` were before.
  void raise(const Estimation& estimation, std::uint32_t mean, std::uint32_t next) {
    if (sampling_ == Sampling::even || next <= kMinSamples) {
      std::ranges::fill(samples_, HalfSamples{next, next});
      return;
    }
    const std::size_t blocks = own().size();
    std::vector<BlockSpread> mine;
    for (std::size_t block = 0; block < blocks; ++block)
      mine.push_back(estimation.spread(block, pilot_samples(mean)));
    deal_samples(next, in_block_order(communicator_, std::span<const BlockSpread>(mine), samples_.size()),
                 samples_);
  }

  /// Those of this rank's blocks.
  [[nodiscard]] std::vector<HalfSamples> own() const {
    std::vector<HalfSamples> mine;
    for (auto block = static_cast<std::size_t>(communicator_.rank()); block < samples_.size();
         block += static_cast<std::size_t>(communicator_.size()))
      mine.push_back(samples_[block]);
    return mine;
  }

  [[nodiscard]] std::uint32_t least() const {
    std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
    for (const HalfSamples& of : samples_) least = std::min({least, of[0], of[1]});
    return least;
  }
  [[nodiscard]] std::uint32_t most() const {
    std::uint32_t most = 0;
    for (const HalfSamples& of : samples_) most = std::max({most, of[0], of[1]});
    return most;
  }

 private:
  const Communicator& communicator_;
  Sampling sampling_;
  std::vector<HalfSamples> samples_;
};

/// A run that ends at the first look at which its error seems to be small enough ends, more often than not,
/// at one that makes it seem smaller than it is. By so much: of one sensor, whose error of 16 randomisations
/// is itself off by 18 %, and less of many, whose errors together are better known. Found by simulation of
/// independent samples with these looks (bench/sequences/selection.py).
double selection_of(const SensorSums& all) {
  constexpr double kOfOneSensor = 0.08;
  double sensors = 0;  // effective number of those that share in the error
  for (int c = 0; c < kChannels; ++c)
    if (all.fourth_power[c] > 0)
      sensors = std::max(sensors, all.squared_error[c] * all.squared_error[c] / all.fourth_power[c]);
  return sensors > 0 ? 1 + kOfOneSensor / sensors : 1;
}

void set_errors(const SensorSums& all, double selection, ReferenceResult& result) {
  if (!(all.weight > 0)) return;
  result.mean = all.mean / all.weight;
  for (int c = 0; c < kChannels; ++c) {
    const double error = selection * std::sqrt(all.squared_error[c] / all.weight);
    if (result.mean[c] != 0)
      result.relative_error[c] = error / std::abs(result.mean[c]);
    else
      result.relative_error[c] = error > 0 ? kUnknown : 0;
    if (all.square[c] > 0)
      result.quadratic_error[c] = error / std::sqrt(all.square[c] / all.weight);
    else
      result.quadratic_error[c] = error < kUnknown ? 0 : kUnknown;
  }
}

/// Of the channel where it is largest, in the sensors' unit.
double absolute_error(const ReferenceResult& result) {
  return largest_channel(glm::abs(result.mean) * result.relative_error);
}

/// How many samples there are after the next pass, while nothing limits it: Sobol points are even by
/// multiples of powers of two.
std::uint32_t next_samples(std::uint32_t samples) {
  return samples < kMinSamples ? kMinSamples : samples + std::bit_floor(samples) / 4;
}

class Passes {
 public:
  Passes(const Communicator& communicator, const Sensors& sensors, const PathGoal& goal)
      : communicator_(communicator),
        limits_(goal.limits),
        margin_(goal.margin),
        sensors_(sensors.size()),
        believed_(goal.sampling == Sampling::even ? kBelievedSamples : kBelievedDealtSamples),
        clock_(communicator) {
    if (!limits_.error.are_set() && !limits_.seconds && !limits_.rays)
      limits_.error.target_error = kReferenceError;
  }

  /// Collective: where the next pass ends; at `result.samples` where there is none. The root's clock counts.
  std::uint32_t next(const ReferenceResult& result, double error) const {
    double next = next_samples(result.samples);
    const double excess = limits_.error.excess(error, absolute_error(result));
    const bool is_good = limits_.error.are_set() && margin_ * excess <= 1;
    if (is_good && is_believed(result)) next = 0;
    if (result.rays == 0 || std::isnan(error) || is_in_vain(result))
      next = 0;  // nothing is measured, or cannot be
    const auto samples = static_cast<double>(result.samples);
    // So that a signal is heard within a minute or so.
    next = std::min(next, samples + std::max(1.0, std::floor(kMaxRaysAPass * samples /
                                                             static_cast<double>(result.rays))));
    if (limits_.rays)
      next = std::min(next, std::floor(samples * (static_cast<double>(*limits_.rays) /
                                                  static_cast<double>(result.rays))));
    if (limits_.seconds) next = std::min(next, std::floor(samples * (*limits_.seconds / seconds())));
    next = std::min(next, static_cast<double>(std::numeric_limits<std::uint32_t>::max()));
    double mine = communicator_.is_root() ? next : kUnknown;
    communicator_.all_min(std::span(&mine, 1));
    return std::max(static_cast<std::uint32_t>(mine), result.samples);
  }

  /// `done`: samples, in the midst of a pass not whole. In it the error is the last pass's and says nothing
  /// new, so that only the first pass says how far it is.
  void report(double done, const ReferenceResult& result, double error, Progress& progress) const {
    const std::string paths = fmt::format("{:.0f} paths a sensor", kRandomisations * done);
    if (limits_.error.are_set()) {
      // What is asked for, as a relative error.
      const double excess = limits_.error.excess(error, absolute_error(result));
      const double target = limits_.error.as_relative(error, error < kUnknown ? excess : 0);
      if (error < kUnknown || result.samples == 0)
        progress.update_error({done, error, target, ErrorLaw::sampling}, paths);
    } else if (limits_.seconds) {
      progress.update(std::min(seconds(), *limits_.seconds), *limits_.seconds, paths);
    } else if (result.samples > 0) {
      const double rays = static_cast<double>(result.rays) / result.samples * done;
      progress.update(rays, static_cast<double>(*limits_.rays), paths);
    }
  }

  [[nodiscard]] bool reached(const ReferenceResult& result, double error) const {
    return !limits_.error.are_set() || result.rays == 0 ||
           (limits_.error.excess(error, absolute_error(result)) <= 1 && is_believed(result));
  }

  [[nodiscard]] bool has_target() const { return limits_.error.are_set(); }

  /// Why there is no further pass.
  [[nodiscard]] ReferenceEnding ending(const ReferenceResult& result, double error) const {
    if (result.stopped) return ReferenceEnding::signal;
    if (result.rays == 0) return ReferenceEnding::nothing;
    if (limits_.error.are_set() && reached(result, error)) return ReferenceEnding::target;
    if (is_in_vain(result)) return ReferenceEnding::in_vain;
    const double of_rays =
        limits_.rays ? static_cast<double>(result.rays) / static_cast<double>(*limits_.rays) : 0;
    const double of_time = limits_.seconds ? seconds() / *limits_.seconds : 0;
    return of_time > of_rays ? ReferenceEnding::time : ReferenceEnding::rays;
  }

  /// By this rank's clock.
  [[nodiscard]] double seconds() const { return clock_.own_seconds(); }

 private:
  [[nodiscard]] double paths(const ReferenceResult& result) const {
    return static_cast<double>(sensors_) * kRandomisations * result.samples;
  }
  /// Whether what the error says is worth something.
  [[nodiscard]] bool is_believed(const ReferenceResult& result) const {
    if (result.samples < believed_) return false;
    const bool is_dark = result.contributions == 0 && result.relative_error == Rgb(0);  // without doubt
    return is_dark || (paths(result) >= kBelievedPaths && result.contributions >= kBelievedContributions);
  }
  [[nodiscard]] bool is_in_vain(const ReferenceResult& result) const {
    return result.relative_error != Rgb(0) && result.contributions == 0 && paths(result) >= kPathsInVain;
  }

  const Communicator& communicator_;
  ReferenceLimits limits_;
  double margin_;
  std::size_t sensors_;
  std::uint32_t believed_;
  RootClock clock_;
};

}  // namespace

std::string_view sentence_of(ReferenceEnding ending) {
  switch (ending) {
    case ReferenceEnding::target:
      return "the target error is reached";
    case ReferenceEnding::rays:
      return "so many rays were asked for";
    case ReferenceEnding::time:
      return "the time is up";
    case ReferenceEnding::signal:
      return "stopped by a signal";
    case ReferenceEnding::nothing:
      return "there is nothing to measure";
    case ReferenceEnding::in_vain:
      return "no path has found light";
  }
  return {};
}

ReferenceResult measure(const Communicator& communicator, const Sensors& sensors, std::size_t columns,
                        const PathGoal& goal, int threads, Progress& progress, DeviceBatch* device) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const SensorBlocks blocks = goal.sampling == Sampling::even || columns == 0
                                  ? SensorBlocks::consecutive(sensors.size())
                                  : SensorBlocks::squares(columns, sensors.size() / columns);
  // What a rank sums of its sensors and sends of them, what the root holds of all in the end, and what all
  // ranks know of every block when samples are dealt.
  const std::uint64_t share = sensors.size() / ranks;
  require_memory(communicator,
                 share * (kRandomisations * sizeof(PathSum) + sizeof(SentEstimate)) +
                     (communicator.is_root() ? sensors.size() * sizeof(SensorEstimate) : 0) +
                     blocks.count() * (2 * sizeof(BlockSpread) + sizeof(HalfSamples)) +
                     (device != nullptr ? device->device().paths_at_once() * DeviceBatch::kBytesOfPath : 0),
                 "the reference", "use more hosts, or measure fewer pixels, elements or cells");
  const BlockedSensors mine = blocks.share(rank, ranks);
  Estimation estimation(sensors, mine, goal.seed, goal.sampling, device);
  BlockDeal deal(communicator, blocks.count(), goal.sampling);
  const Passes passes(communicator, sensors, goal);
  tbb::task_arena arena(threads);

  ReferenceResult result;
  const double processor_start = all_processor_seconds(communicator);
  double error = kUnknown;
  ErrorRule rule;
  for (std::uint32_t samples = kMinSamples; samples > result.samples; samples = passes.next(result, error)) {
    deal.raise(estimation, result.samples, samples);
    agree(communicator, [&] {
      arena.execute([&] {
        estimation.add(deal.own(), [&](double part) {
          passes.report(result.samples + part * (samples - result.samples), result, kUnknown, progress);
        });
      });
    });
    result.devices =
        require_same(communicator, device != nullptr ? device->device().counts() : VerifiedCounts{},
                     "paths of light", cuda::kMostDifferingPaths);
    result.samples = samples;
    result.rays = estimation.rays();
    communicator.all_sum(std::span(&result.rays, 1));
    const PathSum found = found_by_all(communicator, estimation, mine.ends.size(), blocks.count());
    result.contributions = found.contributions();
    rule = {!sensors.may_show_nothing()};
    // What takes one ray alone meets nothing that any light may come from: it is dark without doubt.
    const double paths = static_cast<double>(sensors.size()) * kRandomisations * samples;
    const bool meets_surfaces = static_cast<double>(result.rays) > paths;
    if (sensors.has_light() && result.contributions == 0 && meets_surfaces)
      rule.contribution = Rgb(kUnknown);
    else if (rule.of_each)
      rule.contribution = found.contribution();
    const SensorSums all = sum_all(communicator, estimation, mine.ends.size(), blocks.count(), rule);
    rule.selection = passes.has_target() ? selection_of(all) : 1;
    set_errors(all, rule.selection, result);
    error = largest_channel(result.relative_error);
    result.passes.push_back({samples, result.rays, passes.seconds(),
                             all_processor_seconds(communicator) - processor_start, result.relative_error});
    passes.report(samples, result, error, progress);
    result.stopped = anybody_stops(communicator);
    if (result.stopped) break;
  }
  result.least_samples = deal.least();
  result.most_samples = deal.most();
  result.reached = passes.reached(result, error) || (!goal.is_asked_for && result.contributions > 0);
  result.ending = passes.ending(result, error);

  result.sensors = estimates_on_root(communicator, estimation, mine.sensors, sensors.size(), rule);
  return result;
}

}  // namespace fluxel
