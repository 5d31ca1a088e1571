#include "app/solve_step.hpp"

#include <fmt/format.h>

#include <array>

#include "app/heed_signals.hpp"
#include "app/preview.hpp"
#include "app/stopwatch.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/form_factor_matrix.hpp"
#include "mpi_master/side_view_job.hpp"
#include "solver/choose_solver.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// What follows the last iteration takes as long as one: the residual is computed afresh.
constexpr double kClosingLook = 1;

/// Tells how far a solve is. Ends it after a signal.
IterationObserver observer_for(const Communicator& leaders, const Options& options, Progress& progress) {
  return [&leaders, &options, &progress](const IterationState& state) {
    heed_signals(leaders, options);
    progress.update_error(
        {static_cast<double>(state.iteration), state.error, state.target, ErrorLaw::geometric,
         state.error > state.target ? kClosingLook : 0},
        fmt::format("iteration {}, error bound {:.2g}", state.iteration, state.error_bound));
  };
}

/// Radiosity and where the power goes, by leaders.
void solve_with(const Communicator& leaders, RadiosityOperator& F, const SolveParts& parts,
                const Unknowns& unknowns, std::span<const SideView> views, const Teller& teller,
                Progress& progress, RunReport& report) {
  const Options& options = report.options;
  const ElementView& mesh = parts.subdivided.mesh;
  report.row_sums = find_error_weights(F, unknowns, kSinglePrecisionRounding);
  warn_of_amplifying_rows(parts.scene, mesh, teller, report);
  Solver solver = options.solver;
  if (solver == Solver::automatic) {
    const SolverChoice choice = choose_solver(report.row_sums);
    solver = choice.solver;
    report.solver_reason = choice.reason;
  }
  const DiscretisationError discretisation(mesh.elements, unknowns);
  StopRule stop{options.tolerance.value_or(StopRule{}.tolerance), options.max_iterations};
  if (!options.tolerance && discretisation.known()) {
    stop.discretisation = &discretisation;
    stop.share = options.discretisation_share;
  }
  report.radiosity = solve_radiosity(solver, F, unknowns, report.row_sums, stop,
                                     observer_for(leaders, options, progress), parts.start);
  report.energy = energy_balance(unknowns, *report.radiosity, views);
  if (options.thermal)
    report.thermal = thermal_rows(parts.scene, mesh.elements, unknowns, *report.radiosity, report.row_sums);
}

/// Collective. Where a signal ends it, what is kept is told as it is between steps.
FormFactorMatrix make_matrix(const Communicator& world, const FormFactorParts& parts, const Options& options,
                             int threads, Progress& progress) {
  try {
    return FormFactorMatrix(world, parts, options.form_factor, threads, progress);
  } catch (const StopRequest&) {
    heed_signals(world, options);
    throw;
  }
}

}  // namespace

bool solve_step(const Communicator& world, const SolveParts& parts, const Teller& teller, Progress& progress,
                RunReport& report) {
  const Options& options = report.options;
  const ElementView& mesh = parts.subdivided.mesh;
  const bool two_sided = count_unknowns(mesh.elements).two_sided;
  const Unknowns unknowns =
      world.is_leader() ? make_unknowns(mesh.elements, parts.scene.materials) : Unknowns{};
  Stopwatch watch;

  progress.begin("open sides");
  const NodeArray<SideView> views =
      gather_side_views(world, parts.ray_scene, parts.scene, mesh, two_sided, parts.threads);
  progress.end();
  report.closed = is_closed(views.items());
  FormFactorMatrix matrix = make_matrix(world,
                                        {parts.ray_scene, parts.scene, mesh, parts.visibility, two_sided,
                                         unknowns, views.items(), options.device},
                                        options, parts.threads, progress);
  report.form_factors = matrix.facts();
  report.time.form_factors = watch.lap();
  describe_form_factors(teller, report);

  if (options.preview) {
    progress.begin("preview");
    matrix.lead([&] {
      write_previews(world.leaders(), parts.scene, parts.subdivided, matrix.factors(), unknowns, teller,
                     report);
    });
    progress.end();
    report.time.preview = watch.lap();
  }

  progress.begin("solve");
  matrix.lead([&] {
    solve_with(world.leaders(), matrix.factors(), parts, unknowns, views.items(), teller, progress, report);
  });
  progress.end();
  const std::vector<DeviceFailure> failures = matrix.device_failures(world);
  report.form_factors.gpu_ranks -= static_cast<int>(failures.size());
  warn_of_device_failures("solve", failures, teller, report);
  report.gathered = matrix.gathered();
  report.instruction_set = instruction_set_in_use();
  report.time.solve = watch.lap();
  std::array<std::uint64_t, 2> sums{report.radiosity && !report.radiosity->converged ? 1u : 0u,
                                    proportional_bytes()};
  world.all_sum(sums);
  report.held_bytes = sums[1];
  return sums[0] == 0;
}

}  // namespace fluxel
