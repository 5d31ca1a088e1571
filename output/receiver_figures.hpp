#pragma once

#include <optional>

#include "method/solution.hpp"
#include "output/json_parts.hpp"

namespace fluxel {

/// A value and its standard error, of the same unit.
struct Stated {
  double value = 0, error = 0;
};

/// What lighting standards ask of a grid of light meters, of the colours of their irradiance weighted as for
/// luminance (ITU-R BT.709), which of white light is that of each colour. Errors hold that of the solution,
/// the same of all cells, and the noise of the cells, each its own.
struct ReceiverFigures {
  Stated mean, min, max;     ///< [W/m2] or [lx]
  std::optional<Stated> U0;  ///< uniformity: min over mean (EN 12464-1); none where all is dark
  std::optional<Stated> Ud;  ///< diversity: min over max (EN 12464-2); likewise
};

/// `relative`: the error of the solution. The light has cells.
[[nodiscard]] ReceiverFigures receiver_figures(const SensorLight& light, double relative);

/// By the keys mean, min, max, U0 and Ud, each with value and error.
[[nodiscard]] Json figures_json(const ReceiverFigures& figures);

}  // namespace fluxel
