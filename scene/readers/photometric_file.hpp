#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "core/units.hpp"
#include "scene/intensity_table.hpp"

namespace fluxel {

inline constexpr double kLeastFlux = 1e-12;  ///< [lm] or [W] of a luminaire; less counts as none

/// What a file of photometric data says of a luminaire.
struct PhotometricFile {
  IntensityTable table;              ///< [cd] or [W/sr]
  Units units = Units::photometric;  ///< of the table
  glm::dvec2 size{0};                ///< of the opening along C = 0 and along C = 90 degrees [m]
  bool round = false;                ///< an ellipse of these diameters in place of a rectangle
  std::vector<std::string> notes;
};

}  // namespace fluxel
