#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "image/colour_scale.hpp"
#include "image/tone_map.hpp"

namespace fluxel {

/// Values over a rectangle, to be shown by colours.
struct ValueMap {
  int columns = 0, rows = 0;
  std::vector<double> values;  ///< row by row from the top; not a number: there is none
  std::string title, unit;
  std::vector<std::string> lines;  ///< of text below
  /// Of the rectangle [m]; then isolines are drawn, distances, and values into cells that have room. 0, 0: a
  /// picture, whose pixels stay as they are.
  glm::dvec2 size{0};
};

/// The map in false colours with a legend. Needs a sans-serif font, as any system has that shows text.
/// Throws std::runtime_error where it cannot be drawn.
[[nodiscard]] DisplayPicture draw_value_map(const ValueMap& map, const ColourScale& scale);

}  // namespace fluxel
