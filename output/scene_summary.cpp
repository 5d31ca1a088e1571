#include "output/scene_summary.hpp"

#include <algorithm>
#include <glm/common.hpp>

#include "scene/polygon.hpp"

namespace fluxel {

namespace {

std::array<glm::dvec3, 2> world_bounds(const Scene& scene) {
  glm::dvec3 low(scene.extent), high(-scene.extent);
  for (const Patch& patch : scene.patches)
    for (std::uint32_t c = 0; c < patch.outline.corners; ++c) {
      low = glm::min(low, patch.outline.corner[c]);
      high = glm::max(high, patch.outline.corner[c]);
    }
  return {low + scene.origin, high + scene.origin};
}

/// Of heat what is given, without what the air gives, which follows from the temperatures.
Rgb emitted_power(const Scene& scene, const Piece& piece) {
  const Patch& patch = scene.patch(piece.patch);
  const Material& material = scene.material(patch);
  if (material.thermal)
    return area(corners(piece.outline)) * ((patch.sides & kBack) != 0 ? 2 : 1) *
           Rgb(own_exitance(*material.thermal));
  return area(corners(piece.outline)) *
         ((patch.sides & kBack) != 0 ? material.E + material.back_exitance() : material.E);
}

}  // namespace

SceneSummary summarise(const Scene& scene) {
  SceneSummary summary;
  summary.bounds = world_bounds(scene);
  summary.emitters = static_cast<std::size_t>(std::ranges::count_if(
      scene.patches, [&](const Patch& patch) { return scene.material(patch).emits(); }));
  for (const Piece& piece : scene.pieces) {
    const Rgb power = emitted_power(scene, piece);
    summary.emitted_power += glm::max(power, Rgb(0));
    summary.drawn_power -= glm::min(power, Rgb(0));
  }
  for (const Luminaire& luminaire : scene.luminaires)
    summary.luminaire_power += flux(scene.intensity(luminaire)) * luminaire.scale;
  return summary;
}

std::vector<MaterialUse> use_of_materials(const Scene& scene) {
  std::vector<MaterialUse> uses(scene.materials.size());
  for (const Patch& patch : scene.patches) ++uses[index(patch.material)].patches;
  for (const Piece& piece : scene.pieces) {
    MaterialUse& use = uses[index(scene.patch(piece.patch).material)];
    use.area += area(corners(piece.outline));
    use.emitted_power += emitted_power(scene, piece);
  }
  return uses;
}

}  // namespace fluxel
