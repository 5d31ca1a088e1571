#pragma once

#include <cstdint>

#include "formfactor/free_segments.hpp"
#include "formfactor/view_factor.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// A convex polygon whose points can be drawn, and its unit normal.
struct SampledPolygon {
  SmallPolygon corners;
  glm::dvec3 normal{0};
};

/// How many rays a pair is worth.
struct RayBudget {
  double share = 0;         ///< of the pair in a row's irradiance, the larger of both rows
  double tolerance = 1e-4;  ///< of the error of the share
};

/// What the rays of a pair say.
struct VisibleFraction {
  double value = 0;  ///< of the exchange that nothing stands in, 0..1
  std::uint32_t rays = 0;
};

inline constexpr int kFewestPairRays = RayPacket::kSize;
inline constexpr int kMostPairRays = 1024;

/// The visible fraction of the exchange of two polygons in front of each other. Rays join points of an
/// additive recurrence in four dimensions (Roberts' generalised golden ratio), shifted at random for each
/// `seed` so that pairs err independently (Cranley & Patterson 1976), each weighted by its kernel. A packet
/// of rays that agree is the answer; else more follow, as many as bring the error of the share to the
/// tolerance (the error of a shadow's edge falls as rays^-3/4), at most kMostPairRays.
[[nodiscard]] VisibleFraction visible_fraction(const RayScene& ray_scene, const SampledPolygon& P,
                                               const SampledPolygon& Q, std::uint64_t seed,
                                               const RayBudget& budget);

}  // namespace fluxel
