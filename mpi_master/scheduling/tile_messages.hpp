#pragma once

#include <functional>
#include <span>

#include "mpi_master/communication/communicator.hpp"
#include "visibility/tile_code.hpp"

namespace fluxel {

/// A tile as it is sent and stored.
struct CodedTile {
  TileTag tag = TileTag::blocked;
  TileCode code;  ///< for TileTag::bits only
};

/// Appends the tiles (row, first_column ...) to a message: a header, for each tile a tag and its code where
/// it has bits.
void append_tiles(Bytes& message, std::size_t row, std::size_t first_column,
                  std::span<const CodedTile> tiles);

/// Calls `take(row, column, tag, code)` for each tile of a message, which append_tiles may have made in
/// several parts; all codes are valid. Throws std::runtime_error for bytes that are no tiles.
void decode_tiles(
    const Bytes& message,
    const std::function<void(std::size_t, std::size_t, TileTag, std::span<const std::byte>)>& take);

}  // namespace fluxel
