#include "optics/scattering.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

Ways::Ways(const SideLight& side, bool front, const glm::dvec3& direction, const glm::dvec3& normal) {
  if (!side.active) return;
  if (!side.optics.bounds_clear_body()) {
    add(Way::diffuse, side.rho);
    add(Way::mirror, side.optics.mirror);
    add(Way::through, side.optics.transmission);
    add(Way::diffuse_through, side.optics.diffuse_transmission);
    return;
  }
  const double reflected = fresnel_reflectance(std::abs(glm::dot(direction, normal)),
                                               refraction_ratio(side.optics.refraction_index, front));
  add(Way::mirror, Rgb(reflected));
  add(Way::refracted, Rgb(1 - reflected));
}

glm::dvec3 mirrored(const glm::dvec3& direction, const glm::dvec3& normal) {
  return glm::normalize(direction - 2 * glm::dot(direction, normal) * normal);
}

glm::dvec3 refracted(const glm::dvec3& direction, const glm::dvec3& normal, double ratio) {
  const double cosine = -glm::dot(direction, normal);
  const double squared = 1 - ratio * ratio * (1 - cosine * cosine);
  return glm::normalize(ratio * direction + (ratio * cosine - std::sqrt(std::fmax(0.0, squared))) * normal);
}

double fresnel_reflectance(double cosine, double ratio) {
  const double squared = 1 - ratio * ratio * (1 - cosine * cosine);  // of the cosine behind
  if (!(squared > 0)) return 1;
  const double behind = std::sqrt(squared);
  const double across = (ratio * cosine - behind) / (ratio * cosine + behind);
  const double along = (ratio * behind - cosine) / (ratio * behind + cosine);
  return 0.5 * (across * across + along * along);
}

Departure straight_departure(Way way, const SurfaceOptics& optics, bool front, const glm::dvec3& direction,
                             const glm::dvec3& normal) {
  if (way == Way::mirror) return {mirrored(direction, normal), true};
  if (way == Way::refracted)
    return {refracted(direction, front ? normal : -normal, refraction_ratio(optics.refraction_index, front)),
            false};
  return {direction, false};
}

}  // namespace fluxel
