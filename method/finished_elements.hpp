#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "reference/finished_light.hpp"
#include "scene/scene.hpp"
#include "subdivision/element_finder.hpp"

namespace fluxel {

/// What the elements of a mesh reflect, each side as bright everywhere as on average.
class FinishedElements final : public FinishedLight {
 public:
  /// The finder is that of the mesh; both must outlive this. `reflected` [W/m2] is of all fronts, then, where
  /// there are unknown backs, of all backs.
  FinishedElements(const ElementFinder& finder, const ElementView& mesh, std::vector<Rgb> reflected);

  [[nodiscard]] Rgb reflected(PatchId patch, bool front, const glm::dvec3& point) const override;
  /// Of an element by the power that it reflects.
  [[nodiscard]] std::optional<DrawnPoint> draw(double u, double v) const override;
  [[nodiscard]] double density(PatchId patch, bool front, const glm::dvec3& point) const override;

 private:
  [[nodiscard]] std::size_t unknown_at(PatchId patch, bool front, const glm::dvec3& point) const;
  [[nodiscard]] double brightness(std::size_t unknown) const {
    return std::abs(reflected_[unknown].r) + std::abs(reflected_[unknown].g) +
           std::abs(reflected_[unknown].b);
  }

  const ElementFinder& finder_;
  ElementView mesh_;
  std::vector<Rgb> reflected_;
  std::vector<double> ends_;  // running sums of the power of the unknowns
};

/// rho H of all elements, from their irradiance, both in the order of the unknowns.
[[nodiscard]] std::vector<Rgb> reflected_light(const Scene& scene, const ElementView& mesh,
                                               std::span<const Rgb> H);

}  // namespace fluxel
