#pragma once

#include <cstddef>
#include <cstdint>

#include "visibility/tile.hpp"

namespace fluxel {

/// One tile's answer and what it cost.
struct TracedTile {
  TileTag tag = TileTag::facing_away;
  TileBits bits{};  ///< filled for every tag
  std::uint64_t rays = 0;
};

/// Sets the tag of the tile (row, column) of a matrix of this many elements, some of whose pairs have sides
/// that face each other; completes the bits of one on the diagonal, of which those behind the row are there.
void complete_tile(std::size_t row, std::size_t column, std::size_t elements, TracedTile& tile);

}  // namespace fluxel
