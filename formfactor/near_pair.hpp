#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/choices.hpp"
#include "core/element.hpp"
#include "formfactor/corrections.hpp"
#include "formfactor/power_estimate.hpp"
#include "formfactor/tile_occluders.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// The exchange area of one side of an element with one side of another; 0 front, 1 back.
struct SideExchange {
  std::uint32_t side_i = 0, side_j = 0;
  double G = 0;  ///< [m2], what stands between taken off
};

/// Two flat elements face each other with one pair of sides, or with up to four where each crosses the
/// other's plane.
using SideExchanges = boost::container::static_vector<SideExchange, 4>;

/// Looks at pairs of elements singly, with all that their outlines tell.
class PairExaminer {
 public:
  /// All must outlive this.
  PairExaminer(const OcclusionScene& occlusion, const Scene& scene, const ElementView& mesh,
               const FormFactorOptions& options, const PowerEstimate& power);

  /// The exchange of elements i < j: by the contour integral of the parts that face each other where `near`
  /// or where one crosses the other's plane, by the moments rule where not; of that the visible part,
  /// past `occluders` or by rays where the pair's share of power exceeds kMinShare tolerances or where the
  /// centroids do not face each other, else by `sees`, the bit of the centroids.
  [[nodiscard]] SideExchanges exchange(std::size_t i, std::size_t j, bool near, bool sees,
                                       TileOccluders& occluders, CorrectionCounts& counts) const;

  /// The same by FormFactor::points: the disc rule and a ray between every two points of the elements' grids.
  [[nodiscard]] SideExchanges exchange_by_points(std::size_t i, std::size_t j,
                                                 CorrectionCounts& counts) const;

 private:
  /// What of the exchange of two polygons of elements i and j, G [m2] where nothing stands between, is seen.
  [[nodiscard]] double visible_part(const SampledPolygon& P, const SampledPolygon& Q, double G, std::size_t i,
                                    std::size_t j, double share, TileOccluders& occluders,
                                    CorrectionCounts& counts) const;

  const OcclusionScene& occlusion_;
  const Scene& scene_;
  ElementView mesh_;
  const FormFactorOptions& options_;
  const PowerEstimate& power_;
};

/// Pairs with a smaller share of the power, in tolerances, get no rays of their own.
inline constexpr double kMinShare = 0.4;

/// The error of the power that rays may leave, and how much of it rays that all agree may have missed, in
/// tolerances: rays err at random, so that a row's errors partly cancel.
inline constexpr double kRayTolerance = 0.3, kUnanimousTolerance = 2.5;

/// Shadows are clipped in place of rays where these would be at least so many for each occluder, and
/// occluders are at most so many; and to what part of the error of those rays: behind one occluder the errors
/// of many pairs may have one sign.
inline constexpr double kRaysOfAnOccluder = 64;
inline constexpr std::size_t kMaxClippedOccluders = 4;
inline constexpr double kClippingPart = 0.3;

/// Of the errors that a row's sum may have, how much a single pair may contribute.
inline constexpr double kPairTolerance = 0.1;

}  // namespace fluxel
