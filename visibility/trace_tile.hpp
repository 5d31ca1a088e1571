#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "visibility/ray_scene.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

/// One tile's answer and what it cost.
struct TracedTile {
  TileTag tag = TileTag::blocked;
  TileBits bits{};  ///< filled for every tag
  std::uint64_t rays = 0;
};

/// The visibility of the pairs of tile (row_tile, column_tile), column_tile >= row_tile: a bit is set where
/// unknown sides of both elements face each other and the segment between the centroids, lifted off their
/// planes by the scene's surface_epsilon and run from the lower to the higher element, meets no patch.
/// Elements of one plane never see each other. A tile on the diagonal is symmetric.
[[nodiscard]] TracedTile trace_tile(const RayScene& ray_scene, std::span<const Element> elements,
                                    std::size_t row_tile, std::size_t column_tile);

}  // namespace fluxel
