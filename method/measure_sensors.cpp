#include "method/measure_sensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/hash.hpp"

namespace fluxel {

SensorLight measure_sensors(const Problem& problem, Measured kind, const std::string& receiver,
                            const PathSensors& sensors, int columns, const PathGoal& goal,
                            VerifiedPaths* device) {
  Stopwatch watch;
  SensorLight light;
  light.kind = kind;
  light.receiver = receiver;
  light.columns = columns;
  light.rows = columns > 0 ? static_cast<int>(sensors.size()) / columns : 0;
  const std::string name = light.name();
  problem.progress.begin(name);
  PathGoal own = goal;
  own.seed = hash_bytes(std::as_bytes(std::span(name)), goal.seed);
  std::optional<DeviceBatch> batch;
  if (device != nullptr) batch.emplace(sensors, *device);
  light.measured = measure(problem.world, sensors, static_cast<std::size_t>(columns), own, problem.threads,
                           problem.progress, batch ? &*batch : nullptr);
  problem.progress.end();
  light.seconds = watch.lap().wall;
  const ReferenceResult& result = light.measured;
  const Rgb& error = result.relative_error;
  const double largest = std::max({error.r, error.g, error.b});
  const std::string paths =
      result.least_samples == result.most_samples
          ? fmt::format("{} paths each", kRandomisations * result.samples)
          : fmt::format("{} to {} paths each, {} in the mean", kRandomisations * result.least_samples,
                        kRandomisations * result.most_samples, kRandomisations * result.samples);
  problem.log.say(
      fmt::format("{}: {} sensors, {}, {:.3g} rays, {:.2f} s: {}; standard error {}", name, sensors.size(),
                  paths, static_cast<double>(result.rays), light.seconds, sentence_of(result.ending),
                  std::isfinite(largest) ? fmt::format("{:.3g} % of the mean", 100 * largest) : "not known"));
  if (!result.reached && !result.stopped)
    problem.log.warn(
        fmt::format("{}: the error asked for is not reached: {}", name, sentence_of(result.ending)));
  return light;
}

}  // namespace fluxel
