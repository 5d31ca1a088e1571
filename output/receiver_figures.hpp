#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "method/solution.hpp"
#include "output/json_parts.hpp"
#include "scene/receiver.hpp"

namespace fluxel {

/// A value and its standard error, of the same unit.
struct Stated {
  double value = 0, error = 0;
};

/// Of cells' relative errors.
inline constexpr std::array kErrorBins{0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2};

/// What lighting standards ask of a grid of light meters, of the colours of their irradiance weighted as for
/// luminance (ITU-R BT.709), which of white light is that of each colour. Errors of the least and the
/// largest value hold also what noise makes them more extreme.
struct ReceiverFigures {
  Stated mean, min, max;     ///< [W/m2] or [lx]
  std::optional<Stated> U0;  ///< uniformity: min over mean (EN 12464-1); none where all is dark
  std::optional<Stated> Ud;  ///< diversity: min over max (EN 12464-2); likewise
  /// Cells by their error over their value: how many are below each of kErrorBins and not below the one
  /// before, then all others, dark ones among them.
  std::array<std::size_t, kErrorBins.size() + 1> errors{};
};

/// Of the cells that the receiver measures.
[[nodiscard]] ReceiverFigures receiver_figures(const Receiver& receiver, const SensorLight& light);

/// "VALUE +- ERROR".
[[nodiscard]] std::string stated_text(const Stated& stated);

/// By the keys value and error.
[[nodiscard]] Json stated_json(const Stated& stated);

/// By the keys mean, min, max, U0 and Ud, each with value and error, and error_histogram.
[[nodiscard]] Json figures_json(const ReceiverFigures& figures);

}  // namespace fluxel
