#include "photons/photon_sources.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

PhotonSources::PhotonSources(const RayScene& ray_scene)
    : lift_(static_cast<double>(ray_scene.surface_epsilon())) {
  const Scene& scene = ray_scene.scene();
  for (const Patch& patch : scene.patches)
    if (const Material& material = scene.material(patch);
        material.E.r < 0 || material.E.g < 0 || material.E.b < 0)
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

bool PhotonSources::emits_as(const PhotonSources& other) const {
  const auto same_side = [](const EmittingSide& a, const EmittingSide& b) {
    return a.outline.corners == b.outline.corners && a.outline.corner == b.outline.corner &&
           a.normal == b.normal && a.E == b.E;
  };
  const auto same_luminaire = [](const LuminaireEmission& a, const LuminaireEmission& b) {
    return a.is_same(b);
  };
  return lift_ == other.lift_ && ends_ == other.ends_ && colours_ == other.colours_ &&
         std::ranges::equal(sides_, other.sides_, same_side) &&
         std::ranges::equal(luminaires_, other.luminaires_, same_luminaire);
}

}  // namespace fluxel
