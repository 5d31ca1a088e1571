#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <span>

#include "core/element.hpp"
#include "core/options.hpp"
#include "formfactor/power_estimate.hpp"

namespace fluxel {

/// What can be said of all elements of a tile at once.
struct TileBounds {
  glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
  double area = 0;      ///< largest [m2]
  double variance = 0;  ///< largest mean squared distance from the centroid [m2]
  double power = 0;     ///< largest area times B [W]
  double H = std::numeric_limits<double>::infinity();  ///< least [W/m2]
};

[[nodiscard]] TileBounds tile_bounds(std::span<const Element> elements, std::size_t tile,
                                     const PowerEstimate& power);

/// False where no pair of the two tiles can have a moments_error above `error`.
[[nodiscard]] bool may_be_near(const TileBounds& a, const TileBounds& b, double error);

/// False where no pair of the two tiles can have a share of the power above `share`.
[[nodiscard]] bool may_be_significant(const TileBounds& a, const TileBounds& b, double share);

}  // namespace fluxel
