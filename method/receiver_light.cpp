#include "method/receiver_light.hpp"

#include <algorithm>
#include <cstdint>

#include "core/options.hpp"
#include "method/finished_elements.hpp"
#include "method/glare.hpp"
#include "method/measure_sensors.hpp"
#include "reference/light_paths.hpp"
#include "reference/receiver_sensors.hpp"

namespace fluxel {

namespace {

/// Standard error of the gather, root mean square over the mean of a receiver: of the target error, where
/// there is one, this part, and no less than the other.
constexpr double kShareOfTarget = 0.25, kGatherError = 2.5e-3;

/// Of a receiver: some seconds of a processor, where a small bright source makes the gather converge slowly.
constexpr std::uint64_t kMaxGatherRays = 30'000'000;

}  // namespace

void gather_receivers(const Problem& problem, const ElementView& mesh, std::span<const Rgb> H,
                      Solution& solution) {
  Stopwatch watch;
  const ElementFinder finder(mesh);
  const FinishedElements light(finder, mesh, reflected_light(problem.scene, mesh, H));
  const LightPaths paths(problem.ray_scene, &light);
  PathGoal goal;
  goal.limits.error.target_error =
      std::max(kGatherError, kShareOfTarget * problem.options.target_error.value_or(0));
  goal.limits.rays = kMaxGatherRays;
  for (const Receiver& receiver : problem.sensors.receivers) {
    SensorLight gathered = measure_sensors(problem, Measured::receivers, receiver.name,
                                           *receiver_sensors(paths, receiver), receiver.columns, goal);
    // What has been solved is not thrown away for a signal.
    const bool stopped = gathered.measured.stopped;
    if (stopped) problem.log.warn("a signal has ended the gather of receivers at '" + receiver.name + "'");
    solution.sensors.push_back(std::move(gathered));
    solution.stopped = solution.stopped || stopped;
    if (stopped) break;
  }
  rate_glare(problem, paths, goal, solution);
  const PhaseTime time = watch.lap();
  solution.time.gather.wall += time.wall;
  solution.time.gather.processor += time.processor;
}

}  // namespace fluxel
