#include "reference/leaving_side.hpp"

namespace fluxel {

SideLight leaving_side(const Scene& scene, PatchId id, bool front) {
  SideLight side = side_light(scene, id, front);
  const SurfaceOptics of_other = side_light(scene, id, !front).optics;
  side.optics.transmission = of_other.transmission;
  side.optics.diffuse_transmission = of_other.diffuse_transmission;
  if (!of_other.bounds_clear_body()) side.optics.refraction_index = 0;
  side.active = side.active || side.optics.lets_light_through();
  return side;
}

}  // namespace fluxel
