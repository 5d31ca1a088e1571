#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "optics/intensity_cell.hpp"
#include "scene/intensity_table.hpp"
#include "scene/luminaire.hpp"

namespace fluxel {

/// A ray that leaves a luminaire.
struct EmittedRay {
  glm::dvec3 from{0};       ///< on the opening [m]
  glm::dvec3 direction{0};  ///< unit
};

/// The rays of one luminaire, as often as its intensity says: each carries the same part of the flux. First a
/// cell between the table's angles is drawn by its flux, then a direction in it (see IntensityCell); starts
/// are even over the opening.
class LuminaireEmission {
 public:
  /// What is given must outlive this; the table's flux is above 0.
  LuminaireEmission(const Luminaire& luminaire, const IntensityTable& table);

  /// By numbers of [0, 1): of the cell and gamma in it, of C, and two of the place. Starts `lift` [m] off the
  /// opening, to the side that the ray goes to.
  [[nodiscard]] EmittedRay ray(const std::array<double, 4>& numbers, double lift) const;

  /// Whether rays of the same numbers are the same.
  [[nodiscard]] bool is_same(const LuminaireEmission& other) const;

  /// Whether all rays start at one place.
  [[nodiscard]] bool is_point() const { return luminaire_.size == glm::dvec2(0); }

 private:
  const Luminaire& luminaire_;
  const IntensityTable& table_;
  glm::dvec3 across_;  // unit: C = 90 degrees
  std::vector<IntensityCell> cells_;
  std::vector<double> ends_;  // running sums of the cells' flux
};

}  // namespace fluxel
