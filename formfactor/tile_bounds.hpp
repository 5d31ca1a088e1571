#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <span>

#include "core/element.hpp"
#include "formfactor/pair_rule.hpp"
#include "formfactor/power_estimate.hpp"

namespace fluxel {

/// What can be said of the shapes and places of all elements of a tile at once.
struct TileShape {
  glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
  double area = 0;      ///< largest [m2]
  double variance = 0;  ///< largest mean squared distance from the centroid [m2]
};

/// And of their light.
struct TilePower {
  double most = 0;                                     ///< largest area times B [W]
  double H = std::numeric_limits<double>::infinity();  ///< least irradiance [W/m2]
};

[[nodiscard]] TileShape tile_shape(std::span<const Element> elements, std::size_t tile);
[[nodiscard]] TilePower tile_power(std::span<const Element> elements, std::size_t tile,
                                   const PowerEstimate& power);

/// What the kernel evaluates for all pairs of two tiles.
[[nodiscard]] PairRule rule_between(const TileShape& a, const TileShape& b, const KernelRule& kernel);

/// What a crossing_error may be, over what a moments_error may be. All crossing errors have one sign and add
/// up, but below 1 the search for them costs more than the kernel (concentric spheres of 1780 triangles: 0.4
/// % at 1, 0.1 % at 0.5, for a tenth more of a whole run).
inline constexpr double kCrossingShare = 1;

/// False where no pair of the two tiles can have a moments_error above `error` or a crossing_error above
/// kCrossingShare of it.
[[nodiscard]] bool may_be_near(const TileShape& a, const TileShape& b, double error);

/// A bound of the share that the pair with most power of two tiles has in the other's irradiance.
[[nodiscard]] double largest_share(const TileShape& a, const TilePower& power_a, const TileShape& b,
                                   const TilePower& power_b);

}  // namespace fluxel
