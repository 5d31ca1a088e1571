#include "method/measure_sensors.hpp"
#include "method/methods.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "reference/light_paths.hpp"

namespace fluxel {

Solution trace_paths(const Problem& problem) {
  const LightPaths paths(problem.ray_scene);
  const SensorRequest& wanted = problem.sensors;
  Solution solution;
  solution.converged = true;
  // What is measured is handed on at once, so that a run that ends early has lost nothing.
  const auto add = [&](Measured kind, const std::string& receiver, const Sensors& sensors, int columns) {
    if (solution.stopped) return;
    SensorLight light = measure_sensors(problem, kind, receiver, sensors, columns, problem.paths);
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
    add(Measured::receivers, receiver.name, *cell_sensors(paths, receiver), receiver.columns);
  return solution;
}

}  // namespace fluxel
