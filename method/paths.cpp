#include "method/glare.hpp"
#include "method/measure_sensors.hpp"
#include "method/methods.hpp"
#include "method/say_devices.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/ray_devices.hpp"
#include "reference/light_paths.hpp"
#include "reference/missed_luminaires.hpp"
#include "reference/receiver_sensors.hpp"

namespace fluxel {

Solution trace_paths(const Problem& problem) {
  on_root(problem.world, [&] { refuse_missed_luminaires(problem.scene); });
  const LightPaths paths(problem.ray_scene);
  const SensorRequest& wanted = problem.sensors;
  const PathDevices devices = find_path_devices(problem.world, problem.options, problem.ray_scene, paths);
  say_devices(devices.job, problem.world.size(), problem.log);
  Solution solution;
  if (devices.job.ranks > 0)
    solution.ray_devices = RayDeviceStatistics{devices.job.ranks, devices.job.names, {}};
  solution.converged = true;
  // What is measured is handed on at once, so that a run that ends early has lost nothing.
  const ErrorLimits& asked = problem.paths.limits.error;
  const auto goal_of = [&](Measured kind, const std::string& receiver) {
    PathGoal goal = problem.paths;
    if (!asked.is_of(name_of(kMeasuredNames, kind), receiver)) goal.limits.error = {};
    return goal;
  };
  const auto add = [&](Measured kind, const std::string& receiver, const PathSensors& sensors, int columns) {
    if (solution.stopped) return;
    SensorLight light = measure_sensors(problem, kind, receiver, sensors, columns, goal_of(kind, receiver),
                                        devices.own.get());
    if (solution.ray_devices) solution.ray_devices->counts = light.measured.devices;
    solution.goal_reached = solution.goal_reached && light.measured.reached;
    solution.stopped = anybody_stops(problem.world);
    on_root(problem.world, [&] {
      if (problem.hooks.measured) problem.hooks.measured(light);
    });
    solution.sensors.push_back(std::move(light));
  };
  if (!wanted.elements.empty())
    add(Measured::elements, "", *element_sensors(paths, problem.scene, wanted.elements), 0);
  if (wanted.camera != nullptr)
    add(Measured::picture, "", *pixel_sensors(paths, problem.scene, *wanted.camera, wanted.supersample),
        wanted.camera->width);
  for (const Receiver& receiver : wanted.receivers)
    add(Measured::receivers, receiver.name, *receiver_sensors(paths, receiver), receiver.columns);
  rate_glare(problem, paths, problem.paths, solution);
  warn_of_device_failures(
      "paths of light",
      device_failures_of_all(problem.world, devices.own ? devices.own->failure() : std::string()),
      problem.log);
  return solution;
}

}  // namespace fluxel
