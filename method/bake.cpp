#include "method/bake.hpp"

#include "method/bake_light_map.hpp"
#include "method/bake_mesh.hpp"

namespace fluxel {

bool bakes(const Options& options) { return bakes_mesh(options) || bakes_light_map(options); }

void require_bakeable(const Problem& problem) {
  if (bakes_mesh(problem.options)) require_mesh_fits(problem);
  if (bakes_light_map(problem.options)) require_light_map_fits(problem);
}

void bake(const Problem& problem, IrradianceSource& source, double target, Solution& solution) {
  if (bakes_mesh(problem.options)) bake_mesh(problem, source, target, solution);
  if (bakes_light_map(problem.options)) bake_light_map(problem, source, target, solution);
}

}  // namespace fluxel
