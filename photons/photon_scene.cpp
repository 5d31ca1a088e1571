#include "photons/photon_scene.hpp"

#include <algorithm>

namespace fluxel {

PhotonScene::PhotonScene(const RayScene& ray_scene, const ElementView& mesh,
                         std::span<const Receiver> receivers)
    : ray_scene_(ray_scene),
      first_side_(ray_scene),
      sources_(ray_scene),
      lift_(static_cast<double>(ray_scene.surface_epsilon())),
      elements_(mesh.elements.size()),
      two_sided_(std::ranges::any_of(mesh.elements,
                                     [](const Element& element) { return (element.sides & kBack) != 0; })),
      finder_(mesh),
      crossings_(receivers, (two_sided_ ? 2 : 1) * elements_, 2 * lift_) {
  for (const Receiver& receiver : receivers) cells_.push_back(receiver.size());
  const Scene& scene = ray_scene.scene();
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const PatchId id{static_cast<std::uint32_t>(i)};
    sides_.push_back({side_light(scene, id, true), side_light(scene, id, false)});
  }
}

TallyShape PhotonScene::shape(std::size_t parts, bool has_squares) const {
  return {parts, (two_sided_ ? 2 : 1) * elements_, cells_, has_squares};
}

std::size_t PhotonScene::slot_at(const MetSide& met, const glm::dvec3& at) const {
  if (!met.active || elements_ == 0) return kNoSlot;
  const std::size_t element = finder_.find(met.patch, at);
  if (element == ElementFinder::kNone) return kNoSlot;
  return met.front ? element : elements_ + element;
}

}  // namespace fluxel
