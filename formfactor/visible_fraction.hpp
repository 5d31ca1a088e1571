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
  double share = 0;                   ///< of the pair in a row's irradiance, the larger of both rows
  double tolerance = 1e-4;            ///< of the error of the share
  double unanimous_tolerance = 1e-3;  ///< of the share that rays which all agree may have missed
};

/// At a shadow's edge: how many rays bring the error of a share to its tolerance, and the error of a visible
/// fraction by `rays`; about half of rays^-2/3.
[[nodiscard]] double rays_at_an_edge(const RayBudget& budget);
[[nodiscard]] double error_at_an_edge(double rays);

/// What the rays of a pair say.
struct VisibleFraction {
  double value = 0;          ///< of the exchange that nothing stands in, 0..1
  std::uint32_t rays = 0;    ///< that it is the mean of
  std::uint32_t pilots = 0;  ///< that decided how many, if any did
  bool agree = false;        ///< the pilots, or without any the rays
  /// The mean places on both polygons of the exchange that is seen [m]; of none where nothing is.
  glm::dvec3 at_P{0}, at_Q{0};
};

inline constexpr int kMinPairRays = RayPacket::kSize;
inline constexpr int kMaxPairRays = 1024;

/// The visible fraction of the exchange of two polygons in front of each other. Rays join points of a Sobol
/// sequence in four dimensions, shifted at random for each `seed` so that pairs err independently, each
/// weighted by its kernel: rays_at_an_edge, at most kMaxPairRays. Where rays that agree may be fewer, a
/// packet of pilot rays tells whether they do. It is no part of the mean: rays that are averaged must not
/// decide themselves how many they are, or the mean over many pairs is too large where most is seen and too
/// small where little is.
[[nodiscard]] VisibleFraction visible_fraction(const RayScene& ray_scene, const SampledPolygon& P,
                                               const SampledPolygon& Q, std::uint64_t seed,
                                               const RayBudget& budget);

/// A visible fraction with the standard error that independent randomisations show.
struct FractionEstimate {
  double value = 0;  ///< 0..1
  double error = 0;
  std::uint64_t rays = 0;
};

inline constexpr std::uint64_t kMaxEstimateRays = std::uint64_t{1} << 19;

/// The same by eight independent sequences, doubled until the standard error of their mean is at most
/// `wanted` or kMaxEstimateRays are spent. Where n rays all agree, one in 2 n might still have said
/// otherwise.
[[nodiscard]] FractionEstimate estimate_fraction(const RayScene& ray_scene, const SampledPolygon& P,
                                                 const SampledPolygon& Q, std::uint64_t seed, double wanted);

}  // namespace fluxel
