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

/// Receivers are measured to a part of the target error: the least of their cells decides on what is signed.
constexpr double kMarginOfReceivers = 2;

/// Of a receiver: some tens of seconds of a processor, where light that is seldom found makes it slow.
constexpr std::uint64_t kMaxReceiverRays = 100'000'000;

}  // namespace

void gather_receivers(const Problem& problem, const ElementView& mesh, std::span<const Rgb> H,
                      Solution& solution) {
  Stopwatch watch;
  const ElementFinder finder(mesh);
  const FinishedElements light(finder, mesh, reflected_light(problem.scene, mesh, H));
  // Whatever the solution is, paths are right on average, and what they scatter by is all of the error.
  const LightPaths paths(problem.ray_scene, &light);
  PathGoal goal;
  goal.limits.error.target_error = problem.options.target_error.value_or(kTargetError);
  goal.limits.rays = kMaxReceiverRays;
  goal.margin = kMarginOfReceivers;
  goal.is_asked_for = problem.options.target_error || problem.options.method == Method::hierarchical;
  for (const Receiver& receiver : problem.sensors.receivers) {
    SensorLight gathered = measure_sensors(problem, Measured::receivers, receiver.name,
                                           *receiver_sensors(paths, receiver), receiver.columns, goal);
    // What has been solved is not thrown away for a signal.
    const bool stopped = gathered.measured.stopped;
    solution.goal_reached = solution.goal_reached && gathered.measured.reached;
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
