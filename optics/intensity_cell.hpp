#pragma once

#include <array>
#include <cstddef>

#include "scene/intensity_table.hpp"

namespace fluxel {

/// Angles of a direction from a luminaire [rad].
struct IntensityAngles {
  double C = 0, gamma = 0;
};

/// What a table says between two of its planes C and two of its angles gamma: intensity that is bilinear in
/// these. Directions are drawn as often as it says, without rejection: by inverting the distribution of
/// gamma, then that of C at this gamma (Dmitriev 2002, equation 14, over the flux of the cell in place of the
/// whole sphere's).
class IntensityCell {
 public:
  /// Between the angles of these numbers and the next ones; of a table of one plane the whole turn.
  IntensityCell(const IntensityTable& table, std::size_t c, std::size_t g);

  [[nodiscard]] double flux() const { return flux_; }  ///< [lm] or [W]

  /// The direction of two numbers of [0, 1), of gamma and of C; the cell's flux is above 0.
  [[nodiscard]] IntensityAngles direction(double of_gamma, double of_C) const;

 private:
  [[nodiscard]] double flux_below(double gamma) const;

  std::array<double, 2> C_, gamma_;                 // ends [rad]
  std::array<std::array<double, 2>, 2> intensity_;  // of gamma, of C
  double first_ = 0, slope_ = 0;                    // of the mean over C: at the first gamma, for each radian
  double flux_ = 0;
};

}  // namespace fluxel
