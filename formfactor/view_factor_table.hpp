#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "formfactor/surface_exchange.hpp"

namespace fluxel {

/// Of one surface to another, by the numbers of surface_of.
struct SurfaceViewFactor {
  std::uint32_t from = 0, to = 0;
  double value = 0, error = 0;
};

/// The exchanges of surfaces, in the order of sum_by_surfaces, and the surfaces' areas [m2]. Each stands for
/// the view factors in both directions, so that these, twice as many, need not be held at once.
struct ExchangeTable {
  std::span<const SurfaceExchange> exchanges;
  std::span<const double> areas;  ///< an entry a surface, 0 where there is none
};

/// Calls `visit` with the view factors of each surface that sees any, in the order of the surfaces; `to`
/// ascends.
void visit_rows(const ExchangeTable& table,
                const std::function<void(std::span<const SurfaceViewFactor>)>& visit);

[[nodiscard]] std::size_t count_view_factors(std::span<const SurfaceExchange> exchanges);

/// All of visit_rows at once.
[[nodiscard]] std::vector<SurfaceViewFactor> view_factors_of(const ExchangeTable& table);

/// The sum of each surface's view factors.
[[nodiscard]] std::vector<double> row_sums(const ExchangeTable& table);

/// What can be checked of view factors without knowing better ones.
struct ViewFactorChecks {
  double min_row_sum = 0, mean_row_sum = 0, max_row_sum = 0;  ///< of surfaces that see any, the mean by area
  std::size_t blind = 0;                                      ///< surfaces that see none
  double reciprocity = 0;  ///< largest |A_i F_ij - A_j F_ji| over the larger of both
  double max_error = 0;    ///< largest error estimate
};

[[nodiscard]] ViewFactorChecks check_view_factors(const ExchangeTable& table);

}  // namespace fluxel
