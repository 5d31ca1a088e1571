#include "optics/luminaire_escape.hpp"

#include <algorithm>
#include <glm/exponential.hpp>

#include "formfactor/even_points.hpp"
#include "optics/luminaire_emission.hpp"
#include "scene/scene.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

namespace {

/// Rays of one luminaire, and of all together where there are many.
constexpr std::size_t kRaysOfOne = 4096, kRaysOfAll = std::size_t{1} << 18, kLeastRays = 64;

}  // namespace

LuminaireEscape luminaire_escape(const RayScene& ray_scene) {
  const Scene& scene = ray_scene.scene();
  const FirstSide first_side(ray_scene);
  LuminaireEscape escape;
  Rgb variance(0);
  const std::size_t rays =
      std::clamp(kRaysOfAll / std::max<std::size_t>(1, scene.luminaires.size()), kLeastRays, kRaysOfOne);
  for (std::size_t number = 0; number < scene.luminaires.size(); ++number) {
    const Luminaire& of = scene.luminaires[number];
    const IntensityTable& table = scene.intensity(of);
    const double whole = flux(table);
    escape.flux += whole * of.scale;
    if (!(whole > 0)) continue;
    const LuminaireEmission emission(of, table);
    SobolPoints points(number);
    std::size_t escaped = 0, dark = 0;
    for (std::size_t k = 0; k < rays; ++k) {
      const EmittedRay to = emission.ray(points.next(), static_cast<double>(ray_scene.surface_epsilon()));
      const MetSide met = first_side.meet(to.from, to.direction);
      if (met.patch == kNoPatch)
        ++escaped;
      else if (!met.active)
        ++dark;
    }
    const Rgb of_ray = whole / static_cast<double>(rays) * of.scale;
    escape.escaped += static_cast<double>(escaped) * of_ray;
    escape.dark += static_cast<double>(dark) * of_ray;
    const double lost = static_cast<double>(escaped + dark);
    variance += lost * (1 - lost / static_cast<double>(rays)) * (of_ray * of_ray);
  }
  escape.error = glm::sqrt(variance);
  return escape;
}

}  // namespace fluxel
