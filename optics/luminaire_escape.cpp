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
    double escaped = 0, dark = 0, squares = 0;
    for (std::size_t k = 0; k < rays; ++k) {
      const EmittedRay to = emission.ray(points.next(), static_cast<double>(ray_scene.surface_epsilon()));
      const MetSide met = first_side.meet(to.from, to.direction);
      if (met.patch == kNoPatch)
        escaped += to.weight;
      else if (!met.active)
        dark += to.weight;
      else
        continue;
      squares += to.weight * to.weight;
    }
    const auto count = static_cast<double>(rays);
    escape.escaped += escaped / count * of.scale;
    escape.dark += dark / count * of.scale;
    const double mean = (escaped + dark) / count;
    variance += std::max(0.0, squares / count - mean * mean) / count * (of.scale * of.scale);
  }
  escape.error = glm::sqrt(variance);
  return escape;
}

}  // namespace fluxel
