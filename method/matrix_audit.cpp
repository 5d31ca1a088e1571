#include "method/matrix_audit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "method/audit.hpp"
#include "method/finished_elements.hpp"
#include "mpi_master/communication/agreement.hpp"

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

/// Collective: what the root alone can draw, for all.
AuditSubject subject_of(const Problem& problem, const Solution& solution) {
  const Options& options = problem.options;
  if (!error_is_of_picture(options)) return audit_surfaces(problem.scene, options.thermal);
  std::vector<PicturePlace> places;
  if (problem.world.is_root())
    places = draw_picture_places(problem.ray_scene, *options.camera, options.supersample,
                                 solution.subdivided.raster);
  places = problem.world.all_gather(std::span<const PicturePlace>(places));
  return audit_picture(problem.scene, places, *options.camera, options.supersample);
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
  const AuditSubject subject = subject_of(problem, solution);
  if (subject.places.empty()) return;
  // The leaders have the light: one range, the root's.
  const bool is_root = problem.world.is_root();
  std::vector<double> root_has{is_root ? work_in_paths(solution) : 0};
  problem.world.all_max(std::span(root_has));
  const std::vector<Rgb> H = problem.world.all_gather(is_root ? std::span<const Rgb>(solution.radiosity->H)
                                                              : std::span<const Rgb>());
  const ElementView& mesh = solution.subdivided.mesh;
  const ElementFinder finder(mesh);
  const FinishedElements light(finder, mesh, reflected_light(problem.scene, mesh, H));
  const FinishedElements irradiance(finder, mesh, H);
  StatedLight stated;
  for (const SurfacePlace& place : subject.places)
    stated.B.push_back(place.E +
                       place.rho * irradiance.reflected(place.patch, place.front, place.at.position));
  try {
    solution.audit =
        audit(problem, subject, stated, light, audit_goal(problem.options, root_has[0], 0, std::nullopt));
    solution.stated_error = solution.audit->stated();
    problem.log.say(audit_sentence(*solution.audit));
    problem.log.say(fmt::format("stated error {:.2g} %, of the {} as it is shown: elements of one shade each",
                                100 * *solution.stated_error,
                                error_is_of_picture(problem.options) ? "picture" : "surfaces"));
    if (is_root) warn_of_bias(problem.log, solution);
  } catch (const StopRequest&) {
    problem.log.warn("a signal has ended the audit");
  }
}

}  // namespace fluxel
