#include "core/options.hpp"
#include "method/methods.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/exponential.hpp>
#include <string>
#include <utility>
#include <vector>

#include "method/matrix_audit.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "solver/channels.hpp"
#include "solver/refinement_error.hpp"
#include "visibility/narrow_gaps.hpp"

namespace fluxel {

namespace {

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

/// Collective; the estimate itself on the root.
ErrorEstimate estimate(const Problem& problem, const Solution& solution) {
  const ElementView& mesh = solution.subdivided.mesh;
  ErrorEstimate found;
  found.elements = {mesh.elements.size()};
  if (solution.coarser.empty()) {
    found.why_none = "too few elements can be merged: most are whole patches";
    return found;
  }
  found.why_none = why_coarser_meshes_do_not_tell(problem, solution);
  found.elements_too_large = !found.why_none.empty();
  if (found.elements_too_large) return found;

  std::vector<CoarserRadiosity> coarser;
  Rgb squares(0);  // of the coarse solutions' own errors
  for (const CoarserSolution& solved : solution.coarser) {
    found.elements.push_back(solved.first.size() - 1);
    if (!solved.converged) {
      // Mostly for a gap or a slit that no element resolves.
      found.why_none = "the solution on larger elements does not converge";
      found.elements_too_large = true;
      return found;
    }
    squares += solved.error * solved.error;
    coarser.push_back({{solved.area, solved.B}, solved.first});
  }
  if (!problem.world.is_root()) return found;
  Unknowns unknowns = make_unknowns(mesh.elements, problem.scene.materials);
  found.discretisation = refinement_error({std::move(unknowns.area), solution.radiosity->B}, coarser,
                                          solution.radiosity->mean_square_bound);
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
  if (solution.converged)
    solution.error_estimate = estimate(problem, solution);
  else
    solution.error_estimate->why_none = "the solution has not converged";
  if (problem.world.is_root() && solution.error_estimate->why_none.empty())
    solution.expected_error = std::hypot(largest_channel(solution.error_estimate->discretisation.error),
                                         largest_channel(solution.radiosity->mean_square_bound));
  solution.time.estimate += watch.lap();
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
