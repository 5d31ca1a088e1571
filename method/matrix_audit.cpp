#include "method/matrix_audit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/options.hpp"
#include "method/audit.hpp"
#include "method/element_audit.hpp"
#include "method/element_source.hpp"
#include "mpi_master/communication/host_gather.hpp"

namespace fluxel {

namespace {

/// What the run has done, in rays of paths that take as long.
double work_in_paths(const Solution& solution) {
  constexpr double kRay = 0.3, kPairOfIteration = 0.01;
  const MatrixStatistics& matrix = *solution.matrix;
  const auto rays = static_cast<double>(matrix.visibility ? matrix.visibility->rays : 0);
  return kRay * rays + kPairOfIteration * static_cast<double>(matrix.forecast.pairs) *
                           static_cast<double>(solution.radiosity->iterations);
}

/// A bias cannot come of elements that are shown as one shade each: what the estimate from coarser meshes
/// does not see is in all of them.
void warn_of_bias(Log& log, const Solution& solution) {
  constexpr double kWorthAWord = 0.01;
  const double certain = solution.audit->certain_of_whole();
  if (certain <= std::max(kWorthAWord, solution.expected_error.value_or(0))) return;
  log.warn(fmt::format(
      "paths of light find the whole at least {:.2g} % off, most in {}, {}: gaps, slits or shadows are "
      "narrower than the elements; use a smaller --max-edge, --closure or --method hierarchical",
      100 * certain, solution.audit->worst().name,
      solution.expected_error ? fmt::format("above the {:.2g} % estimated", 100 * *solution.expected_error)
                              : "where there is no estimate"));
}

}  // namespace

void audit_matrix(const Problem& problem, Solution& solution) {
  // The leaders have the light: one part, the root's.
  const bool is_root = problem.world.is_root();
  std::vector<double> root_has{is_root ? work_in_paths(solution) : 0};
  problem.world.all_max(std::span(root_has));
  const SharedArray<Rgb> H = gather_on_hosts(
      problem.world, is_root ? std::span<const Rgb>(solution.radiosity->H) : std::span<const Rgb>());
  std::optional<ElementSource> source;
  if (solution.picture) source.emplace(problem, solution.subdivided.mesh, H.items());
  audit_elements(problem, {H.items(), source ? &*source : nullptr},
                 audit_goal(problem.options, root_has[0], 0, std::nullopt), solution);
  if (!solution.stated_error) return;
  const bool is_of_picture = error_is_of_picture(problem.options);
  problem.log.say(fmt::format("stated error {:.2g} %, of the {} as {} shown{}", 100 * *solution.stated_error,
                              is_of_picture ? "picture" : "surfaces", is_of_picture ? "it is" : "they are",
                              source && is_of_picture ? "" : ": elements of one shade each"));
  if (is_root) warn_of_bias(problem.log, solution);
}

}  // namespace fluxel
