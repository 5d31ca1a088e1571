#include "method/matrix.hpp"

#include <fmt/format.h>

#include <optional>

#include "method/handle_signals.hpp"
#include "method/matrix_radiosity.hpp"
#include "method/matrix_visibility.hpp"
#include "method/methods.hpp"
#include "method/receiver_light.hpp"
#include "method/subdivide.hpp"
#include "mpi_master/steps/forecast.hpp"

namespace fluxel {

namespace {

Shortcuts shortcuts_of(const Options& options) {
  return options.trace_every_pair ? Shortcuts::off : Shortcuts::on;
}

}  // namespace

void solve_mesh(const Problem& problem, const SubdividedScene& subdivided, Solution& solution) {
  const std::span<const Element> elements = subdivided.mesh.elements;
  Stopwatch watch;
  MatrixStatistics& statistics = solution.matrix.emplace();
  const SharedArray<Rgb> start = first_radiosity(problem, subdivided.mesh);

  // 1. What it will cost, before anything heavy starts.
  std::optional<TileTracer> tracer(std::in_place, problem.ray_scene, elements, shortcuts_of(problem.options));
  statistics.forecast = forecast_visibility(problem, *tracer, subdivided.mesh, SampleUse::shares);
  solution.time.forecast = watch.lap();
  handle_signals(problem.world, problem.options, problem.log);

  // 2. The visibility matrix: strips are assigned, bits stay with the owners of their rows.
  Visibility visibility = matrix_visibility(problem, elements, *tracer, solution);
  tracer.reset();  // the solve needs the memory
  solution.time.visibility = watch.lap();
  say_visibility(problem, solution);
  if (problem.options.visibility_only) {
    solution.end = RunEnd::visibility;
    return;
  }
  handle_signals(problem.world, problem.options, problem.log);

  // 3. Radiosity, form factors on the fly, and where the power goes.
  matrix_radiosity(problem, {subdivided, visibility, start.items()}, solution);
}

Solution solve_matrix(const Problem& problem) {
  Solution solution;
  subdivide(
      problem, [&](std::size_t elements) { return least_bytes(problem.world, elements); }, solution);
  // The root alone makes pictures.
  if (!problem.world.is_root()) solution.subdivided.raster = {};
  solve_mesh(problem, solution.subdivided, solution);
  if (solution.end == RunEnd::solution && !problem.sensors.receivers.empty()) {
    // One range, the root's.
    const bool has = problem.world.is_root();
    const std::vector<Rgb> H =
        problem.world.all_gather(has ? std::span<const Rgb>(solution.radiosity->H) : std::span<const Rgb>());
    gather_receivers(problem, solution.subdivided.mesh, H, solution);
  }
  return solution;
}

Solution forecast_matrix(const Problem& problem) {
  Solution solution;
  subdivide(
      problem, [&](std::size_t elements) { return least_bytes(problem.world, elements); }, solution);
  Stopwatch watch;
  const ElementView& mesh = solution.subdivided.mesh;
  const TileTracer tracer(problem.ray_scene, mesh.elements, shortcuts_of(problem.options));
  solution.matrix.emplace().forecast = forecast_visibility(problem, tracer, mesh, SampleUse::totals);
  solution.time.forecast = watch.lap();
  solution.end = RunEnd::forecast;
  return solution;
}

}  // namespace fluxel
