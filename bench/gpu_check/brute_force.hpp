#pragma once

#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda::checks {

/// Whether two elements see each other, by the segment test with each patch of the scene and nothing else:
/// what all lists, trees and shortcuts must come to. `row` comes before `column`.
[[nodiscard]] bool sees_by_brute_force(const TileScene& scene, const End& row, const End& column);

}  // namespace fluxel::cuda::checks
