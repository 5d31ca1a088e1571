#include "photons/photon_sources.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

PhotonSources::PhotonSources(const RayScene& ray_scene)
    : lift_(static_cast<double>(ray_scene.surface_epsilon())) {
  const Scene& scene = ray_scene.scene();
  for (const Material& material : scene.materials)
    if (material.E.r < 0 || material.E.g < 0 || material.E.b < 0)
      throw InputError(fmt::format(
          "material '{}' draws heat (a heat_flux below 0): photons bring power and take none away; give it a "
          "temperature, or use 'fluxel solve'",
          material.name));
  double sum = 0;
  const auto add = [&](double power, const Rgb& colour) {
    ends_.push_back(sum += power * mean_of_colours(colour));
    colours_.push_back(colour / mean_of_colours(colour));
  };
  sides_ = Emitters(scene).sides();
  for (const EmittingSide& side : sides_) add(area(corners(side.outline)), side.E);
  for (const Luminaire& luminaire : scene.luminaires) {
    const IntensityTable& table = scene.intensity(luminaire);
    const double whole = flux(table);
    if (!(whole > 0) || luminaire.scale == Rgb(0)) continue;
    luminaires_.emplace_back(luminaire, table);
    add(whole, luminaire.scale);
  }
}

}  // namespace fluxel
