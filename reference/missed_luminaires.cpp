#include "reference/missed_luminaires.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace fluxel {

void refuse_missed_luminaires(const Scene& scene) {
  const auto shining = std::ranges::find_if(scene.luminaires, [&](const Luminaire& of) {
    return of.size.x * of.size.y == 0 && of.scale != Rgb(0) && largest_intensity(scene.intensity(of)) > 0;
  });
  if (shining == scene.luminaires.end()) return;
  for (const Patch& patch : scene.patches) {
    const Material& material = scene.material(patch);
    const SurfaceOptics& optics = material.optics;
    if (optics.mirror == Rgb(0) && optics.transmission == Rgb(0) && !optics.bounds_clear_body()) continue;
    throw InputError(fmt::format(
        "luminaire '{}' is a {}, and material '{}' sends light on straight: paths from sensors do not find "
        "the light that goes from the one by the other; give the luminaire a size, or use 'fluxel photons'",
        shining->name, shining->size == glm::dvec2(0) ? "point" : "line", material.name));
  }
}

}  // namespace fluxel
