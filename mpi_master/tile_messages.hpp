#pragma once

#include <functional>
#include <span>

#include "mpi_master/communicator.hpp"
#include "visibility/trace_tile.hpp"

namespace fluxel {

/// Tiles (row, first_column ...) as bytes: a header, a tag for each tile, the bits of those that have some.
[[nodiscard]] Bytes encode_tiles(std::size_t row, std::size_t first_column,
                                 std::span<const TracedTile> tiles);

/// Calls `take(row, column, tag, bits)` for each tile. Throws std::runtime_error for bytes that are no tiles.
void decode_tiles(const Bytes& bytes,
                  const std::function<void(std::size_t, std::size_t, TileTag, const TileBits&)>& take);

}  // namespace fluxel
