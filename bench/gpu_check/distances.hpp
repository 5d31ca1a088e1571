#pragma once

#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda::checks {

/// How near a pair's ray comes to being decided the other way [m].
struct NearMiss {
  double edge;  ///< from the ray to the nearest edge of a patch
  double end;   ///< from the ray's nearer end to the nearest patch
};

/// Of the sides that face each other; the least where there are several.
[[nodiscard]] NearMiss near_miss(const TileScene& scene, const End& row, const End& column);

}  // namespace fluxel::cuda::checks
