#include "method/finished_elements.hpp"

namespace fluxel {

Rgb FinishedElements::reflected(PatchId patch, bool front, const glm::dvec3& point) const {
  const std::size_t element = finder_.find(patch, point);
  if (element == ElementFinder::kNone) return Rgb(0);
  const std::size_t unknown = front ? element : elements_ + element;
  return unknown < reflected_.size() ? reflected_[unknown] : Rgb(0);
}

std::vector<Rgb> reflected_light(const Scene& scene, const ElementView& mesh, std::span<const Rgb> H) {
  std::vector<Rgb> reflected(H.begin(), H.end());
  for (std::size_t k = 0; k < reflected.size(); ++k)
    reflected[k] *= scene.material(scene.patch(mesh.elements[k % mesh.elements.size()].patch)).rho;
  return reflected;
}

}  // namespace fluxel
