#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/surface_exchange.hpp"

namespace fluxel {

/// Of one surface to another, by the numbers of surface_of.
struct SurfaceViewFactor {
  std::uint32_t from = 0, to = 0;
  double value = 0, error = 0;
};

/// Both directions of every exchange, in the order of the surfaces. `exchanges` are in that order too, as
/// sum_by_surfaces has them; `areas` [m2]: an entry a surface.
[[nodiscard]] std::vector<SurfaceViewFactor> view_factors_of(std::span<const SurfaceExchange> exchanges,
                                                             std::span<const double> areas);

/// What can be checked of view factors without knowing better ones.
struct ViewFactorChecks {
  double min_row_sum = 0, mean_row_sum = 0, max_row_sum = 0;  ///< of surfaces that see any, the mean by area
  std::size_t blind = 0;                                      ///< surfaces that see none
  double reciprocity = 0;  ///< largest |A_i F_ij - A_j F_ji| over the larger of both
  double max_error = 0;    ///< largest error estimate
};

/// `factors` as view_factors_of gives them.
[[nodiscard]] ViewFactorChecks check_view_factors(std::span<const SurfaceViewFactor> factors,
                                                  std::span<const double> areas);

}  // namespace fluxel
