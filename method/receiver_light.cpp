#include "method/receiver_light.hpp"

#include <cstdint>

#include "method/finished_elements.hpp"
#include "method/measure_sensors.hpp"
#include "reference/light_paths.hpp"

namespace fluxel {

namespace {

/// Standard error of the gather, root mean square over the mean irradiance of a receiver: below what the
/// solution itself is off in most scenes.
constexpr double kGatherError = 2.5e-3;

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
  goal.limits.target_error = kGatherError;
  goal.limits.rays = kMaxGatherRays;
  for (const Receiver& receiver : problem.sensors.receivers) {
    SensorLight gathered = measure_sensors(problem, Measured::receivers, receiver.name,
                                           *cell_sensors(paths, receiver), receiver.columns, goal);
    // What has been solved is not thrown away for a signal.
    const bool stopped = gathered.measured.stopped;
    if (stopped) problem.log.warn("a signal has ended the gather of receivers at '" + receiver.name + "'");
    solution.sensors.push_back(std::move(gathered));
    if (stopped) break;
  }
  const PhaseTime time = watch.lap();
  solution.time.gather.wall += time.wall;
  solution.time.gather.processor += time.processor;
}

}  // namespace fluxel
