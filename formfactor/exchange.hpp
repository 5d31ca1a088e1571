#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "formfactor/visible_fraction.hpp"
#include "visibility/patch_tree.hpp"

namespace fluxel {

/// An exchange area with what is known of its error.
struct Exchange {
  double G = 0;         ///< [m2]
  double error = 0;     ///< of quadrature, at most about this [m2]
  double variance = 0;  ///< of visibility, square of the error [m4]
  std::uint64_t rays = 0;

  Exchange& operator+=(const Exchange& other);
  [[nodiscard]] double total_error() const;  ///< error and standard error together [m2]
};

/// A scene as that which stands between two polygons: for rays, and as patches for shafts.
struct OcclusionScene {
  /// `rays`, of the same scene as `patches`, must outlive this. `shaft_epsilon`: walls nearer than this to a
  /// polygon count as part of it [m].
  OcclusionScene(const RayScene& rays, Scene patches, double shaft_epsilon)
      : ray_scene(rays), occluders(std::move(patches)), tree(occluders), epsilon(shaft_epsilon) {}
  OcclusionScene(const OcclusionScene&) = delete;
  OcclusionScene& operator=(const OcclusionScene&) = delete;

  const RayScene& ray_scene;
  const Scene occluders;
  const PatchTree tree;
  const double epsilon;
};

/// Errors that are allowed [m2].
struct ExchangeTolerance {
  double quadrature = 0;
  double visibility = 0;
};

/// Two polygons in front of each other.
struct ObstructedPair {
  const SampledPolygon& P;
  const SampledPolygon& Q;
  std::span<const PatchId> candidates;  ///< hold all that may stand in their shaft
  std::uint64_t seed = 0;               ///< of the rays between them
};

/// The exchange area of the pair past those of its candidates that stand between. Where certainly nothing
/// does, it is `free`, or the contour integral where that is not known; where one patch certainly blocks, 0.
/// Else the pair is split as long as it is near, and far pairs ask rays until their error, from independent
/// randomisations, is their part of `tolerance` [m2].
[[nodiscard]] Exchange exchange_past(const OcclusionScene& occlusion, const ObstructedPair& pair,
                                     const ExchangeTolerance& tolerance,
                                     const std::optional<Exchange>& free = {});

/// The same of a pair that is far apart, without rays, and without a look at what blocks: nothing where it is
/// near, more than `most` of the candidates stand between, their shadows leave too many parts, or the error
/// would exceed `tolerance` [m2].
[[nodiscard]] std::optional<Exchange> exchange_past_few(const OcclusionScene& occlusion,
                                                        const ObstructedPair& pair, const Exchange& free,
                                                        double tolerance, std::size_t most);

/// The exchange area where nothing stands between, by contour integral with as few points as `tolerance` [m2]
/// allows.
[[nodiscard]] Exchange free_exchange(const SampledPolygon& P, const SampledPolygon& Q, double tolerance);

}  // namespace fluxel
