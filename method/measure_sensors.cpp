#include "method/measure_sensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/hash.hpp"

namespace fluxel {

SensorLight measure_sensors(const Problem& problem, Measured kind, const std::string& receiver,
                            const Sensors& sensors, const PathGoal& goal) {
  Stopwatch watch;
  SensorLight light;
  light.kind = kind;
  light.receiver = receiver;
  const std::string name = light.name();
  problem.progress.begin(name);
  const std::uint64_t seed = hash_bytes(std::as_bytes(std::span(name)), goal.seed);
  light.measured = measure(problem.world, sensors, goal.limits, seed, problem.threads, problem.progress);
  problem.progress.end();
  light.seconds = watch.lap().wall;
  const ReferenceResult& result = light.measured;
  const Rgb& error = result.relative_error;
  problem.log.say(
      fmt::format("{}: {} sensors, {} paths each, {:.3g} rays, {:.2f} s; standard error {:.3g} % of the mean",
                  name, sensors.size(), kRandomisations * result.samples, static_cast<double>(result.rays),
                  light.seconds, 100 * std::max({error.r, error.g, error.b})));
  if (!result.reached && !result.stopped)
    problem.log.warn(fmt::format("{}: the target error is not reached within the other limit", name));
  return light;
}

}  // namespace fluxel
