#include "output/surface_error.hpp"

#include <glm/exponential.hpp>

#include "core/options.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

std::optional<Rgb> surface_error(const RunRecord& record) {
  const Solution& solution = record.solution;
  if (!solution.stated_error || error_is_of_picture(record.options)) return std::nullopt;
  const Unknowns unknowns = make_unknowns(solution.subdivided.mesh.elements, record.scene.materials);
  return *solution.stated_error * area_mean(unknowns, solution.radiosity->B);
}

Rgb error_with_noise(const Rgb& surface_error, const Rgb& noise) {
  return glm::sqrt(surface_error * surface_error + noise * noise);
}

}  // namespace fluxel
