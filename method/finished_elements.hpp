#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "reference/finished_light.hpp"
#include "scene/scene.hpp"
#include "subdivision/element_finder.hpp"

namespace fluxel {

/// What the elements of a mesh reflect, each side as bright everywhere as on average.
class FinishedElements final : public FinishedLight {
 public:
  /// The finder's mesh is that of the elements; it must outlive this. `reflected` [W/m2] is of all fronts,
  /// then, where there are unknown backs, of all backs.
  FinishedElements(const ElementFinder& finder, std::size_t elements, std::vector<Rgb> reflected)
      : finder_(finder), elements_(elements), reflected_(std::move(reflected)) {}

  [[nodiscard]] Rgb reflected(PatchId patch, bool front, const glm::dvec3& point) const override;

 private:
  const ElementFinder& finder_;
  std::size_t elements_;
  std::vector<Rgb> reflected_;
};

/// rho H of all elements, from their irradiance, both in the order of the unknowns.
[[nodiscard]] std::vector<Rgb> reflected_light(const Scene& scene, const ElementView& mesh,
                                               std::span<const Rgb> H);

}  // namespace fluxel
