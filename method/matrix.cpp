#include "method/matrix.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/options.hpp"
#include "method/bake.hpp"
#include "method/coarser_solutions.hpp"
#include "method/element_source.hpp"
#include "method/gathered_picture.hpp"
#include "method/handle_signals.hpp"
#include "method/matrix_radiosity.hpp"
#include "method/matrix_visibility.hpp"
#include "method/measured_heat.hpp"
#include "method/methods.hpp"
#include "method/receiver_light.hpp"
#include "method/subdivide.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/host_gather.hpp"
#include "mpi_master/steps/forecast.hpp"

namespace fluxel {

namespace {

Shortcuts shortcuts_of(const Options& options) {
  return options.trace_every_pair ? Shortcuts::off : Shortcuts::on;
}

}  // namespace

namespace {

/// Collective: the visibility of all pairs of elements, and what it and the rest will cost.
Visibility find_visibility(const Problem& problem, const SubdividedScene& subdivided, Solution& solution) {
  const std::span<const Element> elements = subdivided.mesh.elements;
  Stopwatch watch;
  MatrixStatistics& statistics = solution.matrix.emplace();

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
  return visibility;
}

/// Collective, on all ranks: the coarser solution on the run's own elements, or nothing.
SharedArray<Rgb> from_coarser(const Problem& problem, const CoarserSolutions& coarser,
                              std::vector<Rgb> CoarserSolution::*values) {
  std::vector<Rgb> parts;
  if (problem.world.is_root() && !coarser.empty()) parts = on_parts(coarser[0].*values, coarser[0].first);
  // One part, the root's.
  return gather_on_hosts(problem.world, std::span<const Rgb>(parts));
}

/// Collective: the mesh of the run, after those that are coarser.
void solve_own_mesh(const Problem& problem, Solution& solution) {
  const SharedArray<Rgb> given = first_radiosity(problem, solution.subdivided.mesh);
  Visibility visibility = find_visibility(problem, solution.subdivided, solution);
  if (problem.options.visibility_only) {
    solution.end = RunEnd::visibility;
    return;
  }
  handle_signals(problem.world, problem.options, problem.log);

  if (problem.options.error_estimate) {
    Stopwatch watch;
    problem.progress.begin("coarser meshes");
    try {
      solution.coarser = solve_coarser_meshes(problem, solution.subdivided);
    } catch (const StopRequest&) {
      // What is kept is what the run's own options say.
      handle_signals(problem.world, problem.options, problem.log);
      throw;
    }
    problem.progress.end();
    solution.time.estimate = watch.lap();
  }
  const SharedArray<Rgb> B = from_coarser(problem, solution.coarser, &CoarserSolution::B);
  const SharedArray<Rgb> H = from_coarser(problem, solution.coarser, &CoarserSolution::H);
  const std::span<const Rgb> start = given.items().empty() ? B.items() : given.items();
  matrix_radiosity(problem, {solution.subdivided, visibility, start, {B.items(), H.items()}}, solution);
}

/// Of a picture's mean: what it may be off by as its light is gathered, below what the solution itself is off
/// in most scenes.
constexpr double kPictureError = 1e-2;

/// Collective: light of pixels, and of what is written beside the elements.
void gather_from(const Problem& problem, IrradianceSource& source, Solution& solution) {
  try {
    if (gathers_picture(problem.options)) gather_picture(problem, source, kPictureError, solution);
  } catch (const StopRequest&) {
    problem.log.warn("a signal has ended the gathering of the picture, which shows the elements");
    solution.stopped = true;
    solution.pixel_irradiance.clear();
    solution.picture.reset();
  }
  if (bakes(problem.options) && !solution.stopped) bake(problem, source, 0, solution);
}

/// Collective: light of pixels, of the mesh that is written and of receivers.
void gather_light(const Problem& problem, Solution& solution) {
  Stopwatch watch;
  const ElementView& mesh = solution.subdivided.mesh;
  // One part, the root's.
  const SharedArray<Rgb> H =
      gather_on_hosts(problem.world, problem.world.is_root() ? std::span<const Rgb>(solution.radiosity->H)
                                                             : std::span<const Rgb>());
  if (gathers_picture(problem.options) || bakes(problem.options)) {
    ElementSource source(problem, mesh, H.items());
    // What is not finite is not shown.
    if (std::isfinite(mean_of_colours(source.mean_radiosity()))) gather_from(problem, source, solution);
  }
  solution.time.gather = watch.lap();
  if (problem.options.thermal) measure_heat(problem, mesh, H.items(), solution);
  if (problem.sensors.has_meters()) gather_receivers(problem, mesh, H.items(), solution);
}

}  // namespace

void solve_mesh(const Problem& problem, const SubdividedScene& subdivided, Solution& solution) {
  const SharedArray<Rgb> start = first_radiosity(problem, subdivided.mesh);
  Visibility visibility = find_visibility(problem, subdivided, solution);
  matrix_radiosity(problem, {subdivided, visibility, start.items()}, solution);
}

Solution solve_matrix(const Problem& problem) {
  Solution solution;
  subdivide(
      problem, [&](std::size_t elements) { return least_bytes(problem.world, elements); }, solution);
  // The root alone makes pictures of elements.
  if (!problem.world.is_root() && !gathers_picture(problem.options)) solution.subdivided.raster = {};
  solve_own_mesh(problem, solution);
  const bool gathers =
      gathers_picture(problem.options) || bakes(problem.options) || problem.sensors.has_meters();
  if (solution.end == RunEnd::solution && gathers) gather_light(problem, solution);
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
