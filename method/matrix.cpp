#include "method/matrix.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "method/bake.hpp"
#include "method/element_source.hpp"
#include "method/gathered_picture.hpp"
#include "method/handle_signals.hpp"
#include "method/matrix_radiosity.hpp"
#include "method/matrix_visibility.hpp"
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

namespace {

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
  if (problem.sensors.has_meters()) gather_receivers(problem, mesh, H.items(), solution);
}

}  // namespace

Solution solve_matrix(const Problem& problem) {
  Solution solution;
  subdivide(
      problem, [&](std::size_t elements) { return least_bytes(problem.world, elements); }, solution);
  // The root alone makes pictures of elements.
  if (!problem.world.is_root() && !gathers_picture(problem.options)) solution.subdivided.raster = {};
  solve_mesh(problem, solution.subdivided, solution);
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
