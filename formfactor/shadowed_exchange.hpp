#pragma once

#include <optional>
#include <span>

#include "formfactor/visible_fraction.hpp"

namespace fluxel {

/// So many occluders are clipped exactly; with more, rays are cheaper.
inline constexpr std::size_t kMaxShadows = 16;

/// An integral and the error that halving its cells shows.
struct ShadowedArea {
  double G = 0;      ///< exchange area [m2]
  double error = 0;  ///< of independent parts, added in their squares [m2]
};

/// The exchange area of two polygons in front of each other past flat convex occluders, without rays: the
/// double area integral of obstructed view factors (Walton, Calculation of obstructed view factors by
/// adaptive integration, NISTIR 6925, 2002). From a point of one polygon the part of the other that the
/// occluders leave is cut out exactly and integrated in closed form (Lambert's contour formula, see
/// point_to_polygon); over the points of the first runs a Gauss rule of 2 x 2 points (3 in a triangle), its
/// cells quartered until what that changes is at most their part of `tolerance` [m2]. Points are those of the
/// polygon from which the shadows on the other move least.
///
/// Both polygons are lifted by `lift` [m] for the occluders, as rays are; what is narrower than that between
/// two shadows is dark. Nothing where there are more occluders than kMaxShadows, or shadows leave more parts
/// than are kept.
[[nodiscard]] std::optional<ShadowedArea> shadowed_exchange(const SampledPolygon& P, const SampledPolygon& Q,
                                                            std::span<const PolygonView> occluders,
                                                            double lift, double tolerance);

}  // namespace fluxel
