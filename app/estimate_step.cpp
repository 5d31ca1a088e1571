#include "app/estimate_step.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "app/heed_signals.hpp"
#include "app/stopwatch.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/form_factor_matrix.hpp"
#include "mpi_master/side_view_job.hpp"
#include "solver/channels.hpp"
#include "solver/choose_solver.hpp"
#include "solver/refinement_error.hpp"
#include "subdivision/coarsen.hpp"

namespace fluxel {

namespace {

/// That are solved beside the run's own.
constexpr std::size_t kCoarserMeshes = 2;

/// Of a mesh's elements, at most so many may be left in the next coarser one: else nearly all of them are
/// whole pieces, and it is not coarser in more than name.
constexpr double kMostLeft = 0.9;

/// Of max |B - B*| over the area-mean of B: far below what is looked for, and near what single precision
/// allows.
constexpr double kCoarseTolerance = 1e-5;

/// Collective: the radiosity of another mesh of the scene, on leaders; nothing where it does not converge.
std::optional<MeshRadiosity> solve_mesh(const Communicator& world, const Scene& scene,
                                        const ElementView& mesh, const RayScene& ray_scene,
                                        const Options& options, int threads) {
  SilentProgress silent;
  std::optional<TileTracer> tracer(std::in_place, ray_scene, mesh.elements);
  const RowCosts costs = sample_tiles(world, *tracer, threads).costs;
  Checkpoint keeps_nothing;
  JobDevices devices = find_job_devices(world, options, ray_scene, mesh.elements, *tracer);
  const Visibility visibility =
      compute_visibility(world, *tracer, costs, threads, keeps_nothing, silent, devices.own.get());
  devices.own.reset();
  tracer.reset();  // the matrix needs the memory

  const bool two_sided = count_unknowns(mesh.elements).two_sided;
  Unknowns unknowns = world.is_leader() ? make_unknowns(mesh.elements, scene.materials) : Unknowns{};
  const NodeArray<SideView> views = gather_side_views(world, ray_scene, scene, mesh, two_sided, threads);
  FormFactorMatrix matrix(world, {ray_scene, scene, mesh, visibility, two_sided, unknowns, views.items()},
                          options.form_factor, threads, silent);
  std::optional<MeshRadiosity> result;
  matrix.lead([&] {
    RadiosityOperator& F = matrix.factors();
    const RowSums row_sums = find_error_weights(F, unknowns, kSinglePrecisionRounding);
    Radiosity radiosity =
        solve_radiosity(choose_solver(row_sums).solver, F, unknowns, row_sums,
                        {kCoarseTolerance, options.max_iterations}, [](const IterationState&) {});
    // Rounding may end it before, near enough.
    if (largest_channel(radiosity.mean_square_bound) <= kFinestTolerance)
      result = {std::move(unknowns.area), std::move(radiosity.B)};
  });
  return result;
}

/// Collective, as estimate_step; the estimate itself on the root.
ErrorEstimate estimate(const Communicator& world, const EstimateParts& parts, const RunReport& report) {
  const Options& options = report.options;
  const ElementView& mesh = parts.subdivided.mesh;
  ErrorEstimate found;
  found.elements = {mesh.elements.size()};
  Bytes levels(mesh.elements.size());
  if (options.subdivision == Subdivision::camera) {
    if (world.is_root()) levels = pixel_levels(parts.subdivided.raster, mesh.elements.size());
    world.broadcast(levels);
  }

  std::vector<CoarserRadiosity> coarser;
  bool all_converge = true;
  ElementMesh finer;  // but for the first round, which merges the run's own
  while (coarser.size() < kCoarserMeshes) {
    const int k = static_cast<int>(coarser.size()) + 1;
    const std::span<const Element> elements =
        k == 1 ? mesh.elements : std::span<const Element>(finer.elements);
    CoarseMesh coarse = coarsen(parts.scene, elements, levels, k, std::ldexp(parts.subdivided.max_edge, k));
    if (static_cast<double>(coarse.size()) > kMostLeft * static_cast<double>(elements.size())) break;
    heed_signals(world, options);
    Options of_mesh = options;
    // Errors grow with the elements, so that form factors may be found less well: the same share of them.
    of_mesh.form_factor.tolerance = std::ldexp(options.form_factor.tolerance, k);
    // What has been solved shall not be lost because a GPU fails now.
    if (of_mesh.device == Device::cuda) of_mesh.device = Device::automatic;
    std::optional<MeshRadiosity> radiosity =
        solve_mesh(world, parts.scene, coarse.mesh, parts.ray_scene, of_mesh, parts.threads);
    all_converge = all_converge && radiosity;
    found.elements.push_back(coarse.size());
    coarser.push_back({std::move(radiosity).value_or(MeshRadiosity{}), std::move(coarse.first)});
    finer = std::move(coarse.mesh);
    levels = std::move(coarse.pixel_levels);
  }
  if (coarser.empty()) found.why_none = "too few elements can be merged: most are whole patches";
  if (!world.is_root() || coarser.empty()) return found;

  if (!all_converge) {
    found.why_none = "the solution on larger elements does not converge";
    return found;
  }
  Unknowns unknowns = make_unknowns(mesh.elements, parts.scene.materials);
  found.discretisation = refinement_error({std::move(unknowns.area), report.radiosity->B}, coarser);
  return found;
}

}  // namespace

void estimate_step(const Communicator& world, const EstimateParts& parts, const Teller& teller,
                   Progress& progress, RunReport& report) {
  Stopwatch watch;
  report.error_estimate.emplace();
  if (parts.converged) {
    progress.begin("error estimate");
    try {
      report.error_estimate = estimate(world, parts, report);
    } catch (const StopRequest&) {
      report.error_estimate->why_none = "a signal has ended it";
    }
    progress.end();
  } else {
    report.error_estimate->why_none = "the solution has not converged";
  }
  report.time.estimate = watch.lap();
  if (world.is_root()) describe_estimate(teller, report);
}

}  // namespace fluxel
