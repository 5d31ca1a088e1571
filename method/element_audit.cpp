#include "method/element_audit.hpp"

#include "core/options.hpp"
#include "method/finished_elements.hpp"
#include "method/stated_light.hpp"
#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

namespace {

/// Collective: what the root alone may be able to draw, for all.
AuditSubject subject_of(const Problem& problem, const Raster& raster) {
  const Options& options = problem.options;
  if (!error_is_of_picture(options)) return audit_surfaces(problem.scene, options.thermal);
  std::vector<PicturePlace> places;
  if (problem.world.is_root())
    places = draw_picture_places(problem.ray_scene, *options.camera, options.supersample, raster);
  places = problem.world.all_gather(std::span<const PicturePlace>(places));
  return audit_picture(problem.scene, places, *options.camera, options.supersample);
}

/// What elements of one shade each reflect.
StatedLight shades_at(const FinishedElements& irradiance, const AuditSubject& subject) {
  StatedLight stated;
  for (const SurfacePlace& place : subject.places)
    stated.B.push_back(place.rho * irradiance.reflected(place.patch, place.front, place.at.position));
  return stated;
}

}  // namespace

void audit_elements(const Problem& problem, const AuditedElements& elements, AuditGoal goal,
                    Solution& solution) {
  const AuditSubject subject = subject_of(problem, solution.subdivided.raster);
  if (subject.places.empty()) return;
  const ElementView& mesh = solution.subdivided.mesh;
  const ElementFinder finder(mesh);
  try {
    StatedLight stated;
    if (elements.gathered_by != nullptr && error_is_of_picture(problem.options)) {
      IrradianceSource& source = *elements.gathered_by;
      stated = reflected_at(source, points_of(source.tree(), subject), subject, solution.picture->ray_error);
      goal.noise = solution.picture->error.value_or(0);
    } else {
      stated = shades_at(FinishedElements(finder, mesh, {elements.H.begin(), elements.H.end()}), subject);
    }
    add_emission(subject, stated);
    const FinishedElements light(finder, mesh, reflected_light(problem.scene, mesh, elements.H));
    AuditPaths paths;
    solution.audit = audit(problem, subject, stated, light, goal, paths);
    solution.stated_error = solution.audit->stated();
    problem.log.say(audit_sentence(*solution.audit));
  } catch (const StopRequest&) {
    problem.log.warn("a signal has ended the audit");
  }
}

}  // namespace fluxel
