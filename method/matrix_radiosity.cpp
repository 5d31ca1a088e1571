#include "method/matrix_radiosity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>

#include "core/options.hpp"
#include "method/early_pictures.hpp"
#include "method/handle_signals.hpp"
#include "method/matrix_heat.hpp"
#include "method/methods.hpp"
#include "method/say_devices.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/steps/deal_rows.hpp"
#include "mpi_master/steps/form_factor_matrix.hpp"
#include "mpi_master/steps/own_rows.hpp"
#include "mpi_master/steps/side_view_job.hpp"
#include "optics/element_luminaires.hpp"
#include "solver/choose_solver.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// What follows the last iteration takes as long as one: the residual is computed afresh.
constexpr double kClosingIterations = 1;

/// Reports how far a solve is. Ends it after a signal.
IterationObserver observer_for(const Problem& problem) {
  return [&problem](const IterationState& state) {
    handle_signals(problem.world, problem.options, problem.log);
    problem.progress.update_error(
        {static_cast<double>(state.iteration), state.error, state.target, ErrorLaw::geometric,
         state.error > state.target ? kClosingIterations : 0},
        fmt::format("iteration {}, error bound {:.2g}", state.iteration, state.error_bound));
  };
}

/// Names the groups of the rows that amplify, most rows first.
std::string amplifying_groups(const Scene& scene, const ElementView& mesh,
                              const std::vector<std::size_t>& rows) {
  constexpr std::size_t kNamed = 5;
  std::map<std::string, std::size_t> count;
  for (const std::size_t row : rows) {
    const Element& element = mesh.elements[row % mesh.elements.size()];
    ++count[scene.groups[index(scene.patch(element.patch).group)]];
  }
  std::vector<std::pair<std::string, std::size_t>> groups(count.begin(), count.end());
  std::ranges::stable_sort(groups, std::greater{}, &std::pair<std::string, std::size_t>::second);
  std::string text;
  for (std::size_t k = 0; k < std::min(groups.size(), kNamed); ++k)
    text += fmt::format("{}{} ({})", k == 0 ? "" : ", ", groups[k].first, groups[k].second);
  return groups.size() > kNamed ? text + ", ..." : text;
}

void warn_of_amplifying_rows(const Problem& problem, const ElementView& mesh, const RowSums& row_sums) {
  if (row_sums.amplifying.empty()) return;
  // A prescribed flux reflects all, so that rounding makes its rows amplify: no harm while there is a bound.
  if (problem.options.thermal && row_sums.weights) return;
  problem.log.warn(
      fmt::format("reflectance times the form factors' row sum reaches 1 in {} rows (largest row "
                  "sum {:.4g}), in {}",
                  row_sums.amplifying.size(), row_sums.largest,
                  amplifying_groups(problem.scene, mesh, row_sums.amplifying)));
}

/// Collective: what all ranks have, on leaders; none elsewhere.
template <class T>
std::vector<T> on_leaders(const Communicator& world, const OwnRows& own, const std::vector<T>& mine) {
  const SharedArray<T> all = own.gather(world, mine);
  if (!world.is_leader()) return {};
  return {all.items().begin(), all.items().end()};
}

/// Collective: the row sums of all ranks, on leaders; without the weights.
RowSums row_sums_of_all(const Communicator& world, const OwnRows& own, RowSums mine, std::size_t elements) {
  for (std::size_t& unknown : mine.amplifying) unknown = own.unknown_of_all(unknown, elements);
  mine.sums = on_leaders(world, own, mine.sums);
  mine.amplifying = world.all_gather(std::span<const std::size_t>(mine.amplifying));
  std::ranges::sort(mine.amplifying);
  if (mine.weights) mine.weights->w = mine.weights->v = {};
  return mine;
}

/// Collective: the radiosity of unknowns, this rank's part, by the solver that is asked for.
LinearSolution solve_linear(const Problem& problem, RadiosityOperator& F, const Unknowns& unknowns,
                            const DiscretisationError& discretisation, std::span<const Rgb> start) {
  const Options& options = problem.options;
  LinearSolution found;
  found.row_sums = find_error_weights(F, unknowns, kSinglePrecisionRounding);
  Solver solver = options.solver;
  if (solver == Solver::automatic) {
    const SolverChoice choice = choose_solver(found.row_sums);
    solver = choice.solver;
    found.solver_reason = choice.reason;
  }
  StopRule stop{options.tolerance.value_or(StopRule{}.tolerance), options.max_iterations};
  stop.against_growth = row_of(options.method).remedies.against_growth;
  if (!options.tolerance && discretisation.known()) {
    stop.discretisation = &discretisation;
    stop.share = options.discretisation_share;
  }
  found.radiosity =
      solve_radiosity(solver, {F, unknowns, found.row_sums}, stop, observer_for(problem), start);
  return found;
}

/// Collective: radiosity, into the leaders' solutions.
void solve_with(const Problem& problem, RadiosityOperator& F, const MatrixParts& parts, const OwnRows& own,
                const Unknowns& unknowns, Solution& solution) {
  const ElementView& mesh = parts.subdivided.mesh;
  const std::span<const Element> elements = own.of_elements(mesh.elements);
  const DiscretisationError discretisation(elements, unknowns, F.ranks());
  const std::vector<Rgb> start = own.of(parts.start);
  const auto solve = [&](const Unknowns& linear, std::span<const Rgb> from) {
    return solve_linear(problem, F, linear, discretisation, from);
  };
  LinearSolution found = has_convection(mesh.elements, problem.scene.materials)
                             ? solve_heat(F, elements, problem.scene.materials, unknowns, start, solve,
                                          solution.heat_steps.emplace())
                             : solve(unknowns, start);
  solution.row_sums = row_sums_of_all(problem.world, own, found.row_sums, mesh.elements.size());
  warn_of_amplifying_rows(problem, mesh, solution.row_sums);
  solution.solver_reason = found.solver_reason;
  Radiosity& radiosity = found.radiosity;
  radiosity.B = on_leaders(problem.world, own, radiosity.B);
  radiosity.H = on_leaders(problem.world, own, radiosity.H);
  if (problem.world.is_leader()) solution.radiosity = std::move(radiosity);
}

/// Where the power goes, by leaders.
void find_energy(const Problem& problem, const ElementView& mesh, std::span<const SideView> views,
                 Solution& solution) {
  const Unknowns unknowns = make_unknowns(mesh.elements, problem.scene.materials);
  const Radiosity& radiosity = *solution.radiosity;
  const std::vector<SideSample> samples = all_sides(unknowns, views);
  if (!problem.options.thermal) {
    solution.energy = energy_balance(unknowns, radiosity, samples, luminaire_escape(problem.ray_scene));
    return;
  }
  solution.energy = thermal_balance(mesh.elements, problem.scene.materials, unknowns, radiosity, samples);
  solution.thermal = thermal_rows(problem.scene, mesh.elements, unknowns, radiosity, solution.row_sums);
}

/// Collective. Where a signal ends it, what is kept is reported as between steps.
FormFactorMatrix make_matrix(const Problem& problem, const FormFactorParts& parts) {
  try {
    return FormFactorMatrix(workers_of(problem), parts, problem.options.form_factor);
  } catch (const StopRequest&) {
    handle_signals(problem.world, problem.options, problem.log);
    throw;
  }
}

void say_form_factors(Log& log, const MatrixStatistics& statistics, double seconds) {
  const FormFactorStatistics& factors = *statistics.form_factors;
  log.say(fmt::format(
      "form factors: {} pairs by contour, {} partly visible, {} clipped, {:.4g} rays, {:.3g} GiB; "
      "row sums up to {:.5g}, defect {:.2g} (rms){}; {:.2f} s",
      factors.corrections.near_pairs, factors.corrections.partial_pairs, factors.corrections.clipped_pairs,
      static_cast<double>(factors.corrections.rays), static_cast<double>(factors.correction_bytes) * 0x1p-30,
      factors.row_sum_max, factors.closure_defect_rms,
      // A row above 1 by its rounding alone is not worth a word.
      factors.capped_rows > 0 && factors.row_sum_max > 1.001
          ? fmt::format(", {} rows above 1 scaled down", factors.capped_rows)
          : "",
      seconds));
  if (factors.gpu_ranks < statistics.gpu_ranks)
    log.warn(fmt::format("the processor makes the solve's products of {} of {} ranks with a GPU: {}",
                         statistics.gpu_ranks - factors.gpu_ranks, statistics.gpu_ranks,
                         factors.without_gpu.front().reason));
  if (!factors.closure) return;
  const Closure& closure = *factors.closure;
  log.say(fmt::format("closure: defect {:.2g} to {:.2g} in {} sweeps, entries changed by at most {:.2g}",
                      closure.defect_before, closure.defect_after, closure.sweeps, closure.largest_change));
  if (!closure.trusted)
    log.warn(
        fmt::format("the closure is not to be trusted: it changes form factors by up to {:.2g} and "
                    "leaves a defect of {:.2g} after {} sweeps (form factors are missing or wrong; "
                    "use smaller elements)",
                    closure.largest_change, closure.defect_after, closure.sweeps));
}

}  // namespace

SharedArray<Rgb> first_radiosity(const Problem& problem, const ElementView& mesh) {
  std::vector<Rgb> start;
  on_root(problem.world, [&] {
    if (problem.hooks.start) start = problem.hooks.start(mesh);
  });
  // One part, the root's.
  return gather_on_hosts(problem.world, std::span<const Rgb>(start));
}

void matrix_radiosity(const Problem& problem, const MatrixParts& parts, Solution& solution) {
  const Communicator& world = problem.world;
  MatrixStatistics& statistics = *solution.matrix;
  const ElementView& mesh = parts.subdivided.mesh;
  const bool two_sided = count_unknowns(mesh.elements).two_sided;
  Stopwatch watch;
  deal_rows(world, parts.visibility);
  const OwnRows own(parts.visibility.store.owned(), mesh.elements.size(), two_sided);
  Unknowns unknowns = make_unknowns(own.of_elements(mesh.elements), problem.scene.materials, two_sided);
  unknowns.H0 =
      first_light_of_elements(problem.ray_scene, mesh, own.first, own.count, two_sided, problem.threads);

  problem.progress.begin("escape fractions");
  const SharedArray<SideView> views =
      gather_side_views(world, problem.ray_scene, problem.scene, mesh, two_sided, problem.threads);
  problem.progress.end();
  solution.closed = is_closed(views.items());
  const std::vector<SideView> own_views = own.of(views.items());
  FormFactorMatrix matrix =
      make_matrix(problem, {problem.ray_scene, problem.scene, mesh, parts.visibility, two_sided, unknowns,
                            own_views, problem.options.device, parts.light});
  statistics.form_factors = matrix.statistics();
  solution.form_factor_sums = {matrix.statistics().row_sum_max, matrix.statistics().closure_defect_rms,
                               matrix.statistics().closure};
  solution.time.form_factors = watch.lap();
  say_form_factors(problem.log, statistics, solution.time.form_factors.wall);

  if (problem.options.preview) {
    problem.progress.begin("preview");
    shoot_early_pictures(problem, parts.subdivided, matrix.factors(), unknowns);
    problem.progress.end();
    solution.time.preview = watch.lap();
  }

  problem.progress.begin("solve");
  solve_with(problem, matrix.factors(), parts, own, unknowns, solution);
  if (world.is_leader()) find_energy(problem, mesh, views.items(), solution);
  problem.progress.end();
  const std::vector<DeviceFailure> failures = matrix.device_failures(world);
  statistics.form_factors->gpu_ranks -= static_cast<int>(failures.size());
  warn_of_device_failures("solve", failures, problem.log);
  statistics.gathered = matrix.gathered();
  solution.instruction_set = instruction_set_in_use();
  solution.time.solve = watch.lap();
  std::array<std::uint64_t, 2> sums{solution.radiosity && !solution.radiosity->converged ? 1u : 0u,
                                    proportional_bytes()};
  world.all_sum(sums);
  solution.converged = sums[0] == 0;
  solution.held_bytes = sums[1];
}

}  // namespace fluxel
