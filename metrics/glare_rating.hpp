#pragma once

#include <optional>

namespace fluxel {

/// Guth's position index of a place in the field of view: how much brighter a source may be there than on the
/// line of sight. `from_sight`: its angle from the line of sight; `from_upright`: that of the plane through
/// both from the upright one [rad]. Defined above the line of sight: Levin's fit (1975) to Guth's index
/// (1963), up to 12 % off what CIE 117:1995 has as a table, which is 0.8 of a rating.
[[nodiscard]] double position_index(double from_sight, double from_upright);

/// Of a rating, by the position index: about half of the most that the fit is off.
inline constexpr double kErrorOfPositions = 0.4;

/// What an observer sees of what glares.
struct GlareSources {
  double weighted = 0;     ///< sum of L^2 omega / p^2 [cd2/m4 sr]
  double solid_angle = 0;  ///< of all [sr]
  double largest = 0;      ///< of one [sr]
};

/// A unified glare rating and its standard error.
struct GlareRating {
  double UGR = 0, error = 0;
};

/// UGR = 8 lg (0.25 / L_b sum of L^2 omega / p^2) (CIE 117:1995, equation 3.1; Sorensen 1987), with the
/// background's luminance L_b and its standard error [cd/m2]; the rating's error is that of both and of the
/// position index. None where nothing glares, or where the
/// background is not brighter than its error.
[[nodiscard]] std::optional<GlareRating> glare_rating(const GlareSources& sources, double background,
                                                      double error);

}  // namespace fluxel
