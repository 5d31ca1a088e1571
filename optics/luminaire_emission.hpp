#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/intensity_table.hpp"
#include "scene/luminaire.hpp"

namespace fluxel {

/// A ray that leaves a luminaire.
struct EmittedRay {
  glm::dvec3 from{0};       ///< on the opening [m]
  glm::dvec3 direction{0};  ///< unit
  double weight = 0;        ///< what it carries of the table's flux; the mean over all rays is that flux
};

/// The rays of one luminaire, drawn by its intensity: first a cell between the table's angles, then a
/// direction evenly over the cell's solid angle, with the weight that makes up for what the intensity varies
/// by over it; their starts evenly over the opening.
class LuminaireEmission {
 public:
  /// What is given must outlive this; the table's flux is above 0.
  LuminaireEmission(const Luminaire& luminaire, const IntensityTable& table);

  /// By numbers of [0, 1): of the cell and C in it, of gamma, and two of the place. Starts `lift` [m] off the
  /// opening, to the side that the ray goes to.
  [[nodiscard]] EmittedRay ray(const std::array<double, 4>& numbers, double lift) const;

 private:
  [[nodiscard]] std::size_t next(std::size_t c) const { return table_.C.size() > 1 ? c + 1 : c; }
  [[nodiscard]] double from(std::size_t c) const { return table_.C.size() > 1 ? table_.C[c] : 0; }
  [[nodiscard]] double width(std::size_t c) const;
  [[nodiscard]] double solid_angle(std::size_t c, std::size_t g) const;

  const Luminaire& luminaire_;
  const IntensityTable& table_;
  glm::dvec3 across_;         // unit: C = 90 degrees
  std::vector<double> ends_;  // of the cells, plane by plane: running sums of the most that each may send
};

}  // namespace fluxel
