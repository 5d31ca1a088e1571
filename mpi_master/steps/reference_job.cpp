#include "mpi_master/steps/reference_job.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/root_clock.hpp"
#include "mpi_master/steps/forecast.hpp"
#include "solver/channels.hpp"

namespace fluxel {

namespace {

/// Of a pass; a processor traces some 3e6 a second.
constexpr double kMaxRaysAPass = 1e8;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

std::size_t block_count(std::size_t sensors) { return (sensors + kSensorBlock - 1) / kSensorBlock; }

/// The k-th of a rank's sensors. Blocks go round, so that each rank has its share of dear ones.
std::size_t sensor_of(std::size_t rank, std::size_t ranks, std::size_t k) {
  return (rank + k / kSensorBlock * ranks) * kSensorBlock + k % kSensorBlock;
}

std::vector<std::size_t> sensors_of(std::size_t rank, std::size_t ranks, std::size_t sensors) {
  std::vector<std::size_t> mine;
  for (std::size_t sensor = sensor_of(rank, ranks, 0); sensor < sensors;
       sensor = sensor_of(rank, ranks, mine.size()))
    mine.push_back(sensor);
  return mine;
}

/// What every rank has made of each of its blocks, in the order of the blocks.
std::vector<SensorSums> in_block_order(const Communicator& communicator, std::span<const SensorSums> mine,
                                       std::size_t blocks) {
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::vector<SensorSums> gathered = communicator.all_gather(mine);
  std::vector<SensorSums> sums(blocks);
  std::size_t at = 0;
  for (std::size_t rank = 0; rank < ranks; ++rank)
    for (std::size_t block = rank; block < blocks; block += ranks) sums[block] = gathered[at++];
  return sums;
}

/// Collective: the estimates of all sensors on the root, nothing elsewhere.
std::vector<SensorEstimate> estimates_on_root(const Communicator& communicator, const Estimation& estimation,
                                              std::size_t mine, std::size_t sensors) {
  constexpr int kTag = 16;
  constexpr std::size_t kMaxInAMessage = std::size_t{1} << 20;
  const auto ranks = static_cast<std::size_t>(communicator.size());
  std::vector<SensorEstimate> all(communicator.is_root() ? sensors : 0);
  if (communicator.is_root()) {
    for (std::size_t k = 0; k < mine; ++k) all[sensor_of(0, ranks, k)] = estimation.estimate(k);
  } else {
    for (std::size_t first = 0; first < mine; first += kMaxInAMessage) {
      std::vector<SensorEstimate> some;
      for (std::size_t k = first; k < std::min(first + kMaxInAMessage, mine); ++k)
        some.push_back(estimation.estimate(k));
      const auto bytes = std::as_bytes(std::span(some));
      communicator.send(0, kTag, Bytes(bytes.begin(), bytes.end()));
    }
  }
  std::vector<std::size_t> received(ranks, 0);  // messages of a rank come in their order
  communicator.receive_all([&](const Message& message) {
    const auto rank = static_cast<std::size_t>(message.source);
    for (std::size_t at = 0; at < message.data.size(); at += sizeof(SensorEstimate))
      std::memcpy(&all[sensor_of(rank, ranks, received[rank]++)], message.data.data() + at,
                  sizeof(SensorEstimate));
  });
  return all;
}

/// Sums over all sensors, in the order of the blocks.
SensorSums sum_all(const Communicator& communicator, const Estimation& estimation, std::size_t mine,
                   std::size_t blocks) {
  std::vector<SensorSums> parts;
  for (std::size_t first = 0; first < mine; first += kSensorBlock)
    parts.push_back(estimation.sums(first, std::min(first + kSensorBlock, mine)));
  SensorSums all;
  for (const SensorSums& part : in_block_order(communicator, parts, blocks)) {
    all.weight += part.weight;
    all.mean += part.mean;
    all.squared_error += part.squared_error;
  }
  return all;
}

void set_errors(const SensorSums& all, ReferenceResult& result) {
  if (!(all.weight > 0)) return;
  result.mean = all.mean / all.weight;
  for (int c = 0; c < kChannels; ++c)
    result.relative_error[c] =
        result.mean[c] != 0 ? std::sqrt(all.squared_error[c] / all.weight) / std::abs(result.mean[c]) : 0;
}

/// How many samples there are after the next pass, while nothing limits it: Sobol points are even by
/// multiples of powers of two.
std::uint32_t next_samples(std::uint32_t samples) {
  return samples < kMinSamples ? kMinSamples : samples + std::bit_floor(samples) / 4;
}

class Passes {
 public:
  Passes(const Communicator& communicator, const ReferenceLimits& limits)
      : communicator_(communicator), limits_(limits), clock_(communicator) {
    if (!limits.target_error && !limits.seconds && !limits.rays) limits_.target_error = kReferenceError;
  }

  /// Collective: where the next pass ends; at `result.samples` where there is none. The root's clock counts.
  std::uint32_t next(const ReferenceResult& result, double error) const {
    double next = next_samples(result.samples);
    const bool is_good = limits_.target_error && error <= *limits_.target_error;
    if (is_good && result.samples >= kBelievedSamples) next = 0;
    if (result.rays == 0 || !std::isfinite(error)) next = 0;  // nothing is measured, or cannot be
    const auto samples = static_cast<double>(result.samples);
    // By 1 / sqrt(samples), and a hundredth more: else the last pass would go well beyond the target.
    if (limits_.target_error && !is_good)
      next = std::min(next, std::ceil(1.01 * samples * std::pow(error / *limits_.target_error, 2)));
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
    if (limits_.target_error) {
      if (error < kUnknown || result.samples == 0)
        progress.update_error({done, error, *limits_.target_error, ErrorLaw::sampling}, paths);
    } else if (limits_.seconds) {
      progress.update(std::min(seconds(), *limits_.seconds), *limits_.seconds, paths);
    } else if (result.samples > 0) {
      const double rays = static_cast<double>(result.rays) / result.samples * done;
      progress.update(rays, static_cast<double>(*limits_.rays), paths);
    }
  }

  [[nodiscard]] bool reached(double error) const {
    return !limits_.target_error || error <= *limits_.target_error;
  }

  /// By this rank's clock.
  [[nodiscard]] double seconds() const { return clock_.own_seconds(); }

 private:
  const Communicator& communicator_;
  ReferenceLimits limits_;
  RootClock clock_;
};

/// Collective: processor time of all ranks [s].
double all_processor_seconds(const Communicator& communicator) {
  auto microseconds = static_cast<std::uint64_t>(1e6 * processor_seconds());
  communicator.all_sum(std::span(&microseconds, 1));
  return 1e-6 * static_cast<double>(microseconds);
}

}  // namespace

ReferenceResult measure(const Communicator& communicator, const Sensors& sensors,
                        const ReferenceLimits& limits, std::uint64_t seed, int threads, Progress& progress) {
  const auto ranks = static_cast<std::uint64_t>(communicator.size());
  // What a rank sums of its sensors and sends of them, and what the root holds of all in the end.
  const std::uint64_t share = sensors.size() / ranks;
  require_memory(communicator,
                 share * (kRandomisations * sizeof(Rgb) + sizeof(SensorEstimate)) +
                     (communicator.is_root() ? sensors.size() * sizeof(SensorEstimate) : 0),
                 "the reference", "use more hosts, or measure fewer pixels, elements or cells");
  const std::size_t blocks = block_count(sensors.size());
  const std::vector<std::size_t> mine =
      sensors_of(static_cast<std::size_t>(communicator.rank()), static_cast<std::size_t>(communicator.size()),
                 sensors.size());
  Estimation estimation(sensors, mine, seed);
  const Passes passes(communicator, limits);
  tbb::task_arena arena(threads);

  ReferenceResult result;
  const double processor_start = all_processor_seconds(communicator);
  double error = kUnknown;
  for (std::uint32_t samples = kMinSamples; samples > result.samples; samples = passes.next(result, error)) {
    arena.execute([&] {
      estimation.add(result.samples, samples, [&](std::size_t ready) {
        const double part = static_cast<double>(ready) / static_cast<double>(mine.size());
        passes.report(result.samples + part * (samples - result.samples), result, kUnknown, progress);
      });
    });
    result.samples = samples;
    result.rays = estimation.rays();
    communicator.all_sum(std::span(&result.rays, 1));
    set_errors(sum_all(communicator, estimation, mine.size(), blocks), result);
    error = largest_channel(result.relative_error);
    result.passes.push_back({samples, result.rays, passes.seconds(),
                             all_processor_seconds(communicator) - processor_start, result.relative_error});
    passes.report(samples, result, error, progress);
    result.stopped = anybody_stops(communicator);
    if (result.stopped) break;
  }
  result.reached = passes.reached(error);

  result.sensors = estimates_on_root(communicator, estimation, mine.size(), sensors.size());
  return result;
}

}  // namespace fluxel
