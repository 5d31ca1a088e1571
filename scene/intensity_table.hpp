#pragma once

#include <cstddef>
#include <vector>

namespace fluxel {

/// The far field of a luminaire: its intensity in the directions (C, gamma) of the C planes (CIE 121:1996;
/// type C of ANSI/IES LM-63), bilinear between the angles. gamma is the angle from the luminaire's axis (its
/// nadir), C the angle about it, from its C0 plane towards its C90 plane. Directions of no angle of the
/// table, as above its last gamma, get nothing.
struct IntensityTable {
  std::vector<double> C;          ///< ascending [rad], from 0 to 2 pi; one alone (0): the same for all C
  std::vector<double> gamma;      ///< ascending [rad], within 0 to pi; at least two
  std::vector<double> intensity;  ///< [cd] or [W/sr]: gamma by gamma for each C

  [[nodiscard]] double at(std::size_t c, std::size_t g) const { return intensity[c * gamma.size() + g]; }
};

/// The intensity in a direction; `C` of any turn [rad], `gamma` from 0 to pi [rad].
[[nodiscard]] double intensity(const IntensityTable& table, double C, double gamma);

/// The integral of the very function `intensity` over the sphere, in closed form [lm] or [W].
[[nodiscard]] double flux(const IntensityTable& table);

/// The largest value of the table.
[[nodiscard]] double largest_intensity(const IntensityTable& table);

}  // namespace fluxel
