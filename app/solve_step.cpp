#include "app/solve_step.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/heed_signals.hpp"
#include "app/preview.hpp"
#include "app/stopwatch.hpp"
#include "mpi_master/form_factor_matrix.hpp"
#include "mpi_master/side_view_job.hpp"
#include "solver/choose_solver.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// Shows how far a solve is: the bound falls geometrically, so its logarithm tells. Ends it after a signal.
IterationObserver observer_for(const Communicator& world, const Options& options, Progress& progress,
                               double tolerance) {
  return [&world, &options, &progress, tolerance, first = 0.0](int iteration, double bound) mutable {
    heed_signals(world, options);
    if (first == 0 && std::isfinite(bound) && bound > tolerance) first = bound;
    const double all = first > 0 ? std::log(first / tolerance) : 0;
    const double done = first > 0 ? std::log(first / std::max(bound, tolerance)) : 0;
    progress.update(done, all, fmt::format("iteration {}, error bound {:.2g}", iteration, bound));
  };
}

}  // namespace

void solve_step(const Communicator& world, const SolveParts& parts, const Teller& teller, Progress& progress,
                RunReport& report) {
  const Options& options = report.options;
  const ElementMesh& mesh = parts.subdivided.mesh;
  const Unknowns unknowns = make_unknowns(mesh.elements, parts.scene.materials);
  Stopwatch watch;

  progress.begin("form factors");
  const std::vector<SideView> views =
      gather_side_views(world, parts.ray_scene, parts.scene, mesh, unknowns.two_sided, parts.threads);
  report.closed = is_closed(views);
  FormFactorMatrix matrix(world, {parts.ray_scene, parts.scene, mesh, parts.visibility, unknowns, views},
                          options.form_factor, parts.threads, progress);
  progress.end();
  report.form_factors = matrix.facts();
  report.time.form_factors = watch.lap();
  describe_form_factors(teller, report);

  if (options.preview) {
    progress.begin("preview");
    write_previews(world, parts.scene, parts.subdivided, matrix.factors(), unknowns, teller, report);
    progress.end();
    report.time.preview = watch.lap();
  }

  progress.begin("solve");
  report.row_sums = find_error_weights(matrix.factors(), unknowns, kSinglePrecisionRounding);
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
  report.radiosity = solve_radiosity(solver, matrix.factors(), unknowns, report.row_sums, stop,
                                     observer_for(world, options, progress, stop.tolerance), parts.start);
  progress.end();
  report.gathered = matrix.gathered();
  report.instruction_set = instruction_set_in_use();
  report.energy = energy_balance(unknowns, *report.radiosity, views);
  if (options.thermal)
    report.thermal = thermal_rows(parts.scene, mesh.elements, unknowns, *report.radiosity, report.row_sums);
  report.time.solve = watch.lap();
}

}  // namespace fluxel
