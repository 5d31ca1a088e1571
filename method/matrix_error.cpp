#include "method/methods.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/exponential.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "method/handle_signals.hpp"
#include "method/matrix.hpp"
#include "method/matrix_audit.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "solver/channels.hpp"
#include "solver/refinement_error.hpp"
#include "subdivision/coarsen.hpp"
#include "visibility/narrow_gaps.hpp"

namespace fluxel {

namespace {

/// That are solved beside the run's own.
constexpr std::size_t kCoarserMeshes = 2;

/// Of a mesh's elements, at most so many may be left in the next coarser one: else nearly all of them are
/// whole pieces, and it is not coarser in more than name.
constexpr double kMaxLeft = 0.9;

/// Of max |B - B*| over the area-mean of B: far below what is looked for, and near what single precision
/// allows.
constexpr double kCoarseTolerance = 1e-5;

/// Where nearly all light is reflected rounding leaves more, but no more than this root mean square, which
/// becomes a part of the estimate.
constexpr double kMostOfCoarse = 2e-3;

/// Light in gaps that elements are too large for, of all: more is an error that coarser meshes do not see.
constexpr double kMostInGaps = 0.005;

/// Collective, though only the root, which has the light, knows the reason; others say that there is one.
std::string why_coarser_meshes_do_not_tell(const Problem& problem, const Solution& solution) {
  NarrowGaps gaps;
  if (problem.world.is_root())
    gaps = find_narrow_gaps(problem.ray_scene, solution.subdivided.mesh, solution.radiosity->H);
  std::array<double, 1> share{gaps.share};
  problem.world.all_max(share);
  if (share[0] <= kMostInGaps) return {};
  return fmt::format(
      "{:.2g} % of the light falls into gaps that elements are too large for, most between '{}' and '{}', "
      "{:.2g} m apart, by elements of {:.2g} m: coarser ones see no more of it; use a smaller --max-edge or "
      "--method hierarchical",
      100 * gaps.share, gaps.group, gaps.other, gaps.width, gaps.length);
}

/// The run's options for a mesh that is `level` steps coarser.
Options coarse_options(const Options& of_run, int level) {
  Options options = of_run;
  // Errors grow with the elements, so that form factors may be found less well: the same share of them.
  options.form_factor.tolerance = std::ldexp(of_run.form_factor.tolerance, level);
  // What has been solved shall not be lost because a GPU fails now.
  if (options.device == Device::cuda) options.device = Device::automatic;
  options.solver = Solver::automatic;
  options.tolerance = kCoarseTolerance;
  options.checkpoint.clear();
  options.reuse_visibility.clear();
  options.resume = options.preview = options.trace_every_pair = false;
  return options;
}

struct CoarseSolution {
  MeshRadiosity radiosity;
  Rgb error{0};  ///< bound for the root mean square over the area-mean
};

/// Collective: the radiosity of another mesh of the scene, on leaders; nothing where it does not converge.
std::optional<CoarseSolution> solve_coarse(const Problem& problem, const ElementView& mesh, int level) {
  SilentProgress no_progress;
  SilentLog no_log;
  const Options options = coarse_options(problem.options, level);
  SubdividedScene subdivided;
  subdivided.mesh = mesh;
  Solution solution;
  solve_mesh(
      {problem.world, problem.scene, problem.ray_scene, {}, options, problem.threads, no_progress, no_log},
      subdivided, solution);
  // Rounding may end the iteration before the tolerance, near enough.
  if (!solution.radiosity || largest_channel(solution.radiosity->mean_square_bound) > kMostOfCoarse)
    return std::nullopt;
  return CoarseSolution{
      {make_unknowns(mesh.elements, problem.scene.materials).area, std::move(solution.radiosity->B)},
      solution.radiosity->mean_square_bound};
}

/// Collective; the estimate itself on the root.
ErrorEstimate estimate(const Problem& problem, const Solution& solution) {
  const ElementView& mesh = solution.subdivided.mesh;
  ErrorEstimate found;
  found.elements = {mesh.elements.size()};
  Bytes levels(mesh.elements.size());
  if (problem.options.subdivision == Subdivision::camera) {
    if (problem.world.is_root()) levels = pixel_levels(solution.subdivided.raster, mesh.elements.size());
    problem.world.broadcast(levels);
  }

  std::vector<CoarserRadiosity> coarser;
  bool all_converge = true;
  Rgb squares(0);     // of the coarse solutions' own errors
  ElementMesh finer;  // but for the first step, which merges the run's own
  while (coarser.size() < kCoarserMeshes) {
    const int k = static_cast<int>(coarser.size()) + 1;
    const std::span<const Element> elements =
        k == 1 ? mesh.elements : std::span<const Element>(finer.elements);
    CoarseMesh coarse =
        coarsen(problem.scene, elements, levels, k, std::ldexp(solution.subdivided.max_edge, k));
    if (static_cast<double>(coarse.size()) > kMaxLeft * static_cast<double>(elements.size())) break;
    handle_signals(problem.world, problem.options, problem.log);
    if (k == 1) {
      found.why_none = why_coarser_meshes_do_not_tell(problem, solution);
      found.elements_too_large = !found.why_none.empty();
      if (found.elements_too_large) return found;
    }
    std::optional<CoarseSolution> solved = solve_coarse(problem, coarse.mesh, k);
    all_converge = all_converge && solved;
    found.elements.push_back(coarse.size());
    CoarseSolution solution_of_coarse = std::move(solved).value_or(CoarseSolution{});
    squares += solution_of_coarse.error * solution_of_coarse.error;
    coarser.push_back({std::move(solution_of_coarse.radiosity), std::move(coarse.first)});
    finer = std::move(coarse.mesh);
    levels = std::move(coarse.pixel_levels);
  }
  if (coarser.empty()) found.why_none = "too few elements can be merged: most are whole patches";
  if (!problem.world.is_root() || coarser.empty()) return found;

  if (!all_converge) {
    // Mostly for a gap or a slit that no element resolves.
    found.why_none = "the solution on larger elements does not converge";
    found.elements_too_large = true;
    return found;
  }
  Unknowns unknowns = make_unknowns(mesh.elements, problem.scene.materials);
  found.discretisation = refinement_error({std::move(unknowns.area), solution.radiosity->B}, coarser);
  Rgb& error = found.discretisation.error;
  error = glm::sqrt(error * error + squares);
  return found;
}

void say_estimate(Log& log, const Solution& solution) {
  const ErrorEstimate& estimate = *solution.error_estimate;
  if (!estimate.why_none.empty()) {
    const std::string sentence = fmt::format("no error estimate: {}", estimate.why_none);
    estimate.elements_too_large ? log.warn(sentence) : log.say(sentence);
    return;
  }
  log.say(fmt::format(
      "error estimate: elements {:.2g} %, iteration at most {:.2g} % of the mean B (rms); {:.2f} s",
      100 * largest_channel(estimate.discretisation.error),
      100 * largest_channel(solution.radiosity->mean_square_bound), solution.time.estimate.wall));
}

/// Collective.
void estimate_elements(const Problem& problem, Solution& solution) {
  Stopwatch watch;
  solution.error_estimate.emplace();
  if (solution.converged) {
    problem.progress.begin("error estimate");
    try {
      solution.error_estimate = estimate(problem, solution);
    } catch (const StopRequest&) {
      solution.error_estimate->why_none = "a signal has ended it";
    }
    problem.progress.end();
  } else {
    solution.error_estimate->why_none = "the solution has not converged";
  }
  if (problem.world.is_root() && solution.error_estimate->why_none.empty())
    solution.expected_error = std::hypot(largest_channel(solution.error_estimate->discretisation.error),
                                         largest_channel(solution.radiosity->mean_square_bound));
  solution.time.estimate = watch.lap();
  if (problem.world.is_root()) say_estimate(problem.log, solution);
}

}  // namespace

void estimate_matrix_error(const Problem& problem, Solution& solution) {
  if (problem.options.error_estimate) estimate_elements(problem, solution);
  Stopwatch watch;
  if (problem.options.audit > 0 && solution.converged) {
    if (solution.heat_steps)
      problem.log.say(
          "no audit: paths of light do not know what faces with convection send, which follows from their "
          "temperatures");
    else
      audit_matrix(problem, solution);
  }
  solution.time.audit = watch.lap();
}

}  // namespace fluxel
