#include "method/bake.hpp"

#include <string>

#include "method/bake_light_map.hpp"
#include "method/bake_mesh.hpp"
#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

bool bakes(const Options& options) { return bakes_mesh(options) || bakes_light_map(options); }

void require_bakeable(const Problem& problem) {
  if (bakes_mesh(problem.options)) require_mesh_fits(problem);
  if (bakes_light_map(problem.options)) require_light_map_fits(problem);
}

void bake(const Problem& problem, IrradianceSource& source, double target, Solution& solution) {
  // What has been solved is not thrown away for a signal.
  std::string what = "mesh, which shows the elements";
  try {
    if (bakes_mesh(problem.options)) bake_mesh(problem, source, target, solution);
    what = "light map, which is not written";
    if (bakes_light_map(problem.options)) bake_light_map(problem, source, target, solution);
  } catch (const StopRequest&) {
    problem.log.warn("a signal has ended the gathering of the " + what);
    solution.stopped = true;
  }
}

}  // namespace fluxel
