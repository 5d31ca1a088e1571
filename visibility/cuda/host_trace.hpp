#pragma once

#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

/// What the device makes of a tile, by the same code on the host, whose arrays the scene must have: to test
/// it.
[[nodiscard]] TileResult trace_on_host(const TileScene& scene, const TilePlace& place);

}  // namespace fluxel::cuda
