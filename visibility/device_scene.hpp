#pragma once

#include <span>

#include "core/element.hpp"
#include "visibility/cuda/scene_arrays.hpp"
#include "visibility/ray_scene.hpp"
#include "visibility/traced_tile.hpp"

namespace fluxel {

/// The scene as a GPU takes it.
[[nodiscard]] cuda::SceneArrays device_scene(const RayScene& ray_scene, std::span<const Element> elements);

/// A tile that a GPU has made, as TileTracer would have: `rays` are those that something may stand in the way
/// of.
[[nodiscard]] TracedTile traced_tile(const cuda::TileResult& result, const cuda::TilePlace& place,
                                     std::size_t elements);

}  // namespace fluxel
