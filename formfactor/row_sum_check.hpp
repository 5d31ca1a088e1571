#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/view_factor_table.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// A surface whose view factors do not add up to what its rays see.
struct DoubtfulRow {
  std::uint32_t surface = 0;  ///< by surface_of, of groups
  double sum = 0;             ///< of its view factors
  double seen = 0;            ///< part of its rays that end on sides that are unknowns: 1 in a closed room
};

/// Rows of groups' surfaces that are off by more than what is stated of their view factors and five standard
/// errors of the rays, cosine-distributed (Malley's method) from points all over the surface: 65,536 of each
/// where groups are few, and four million in all, so that a hundredth is seen to be missing.
[[nodiscard]] std::vector<DoubtfulRow> doubtful_rows(const RayScene& ray_scene,
                                                     const ExchangeTable& of_groups);

}  // namespace fluxel
