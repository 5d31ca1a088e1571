#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "visibility/tile.hpp"

namespace fluxel {

/// A finished tile as it is sent and kept: its tag and, where it has bits, their code.
struct TileView {
  TileTag tag = TileTag::blocked;
  std::span<const std::byte> code;  ///< for TileTag::bits only
};

/// Appends a byte for the tag, and the code of a tile with bits.
void append_tile(std::vector<std::byte>& bytes, const TileView& tile);

/// Takes the tile that `bytes`, from wherever they come, begin with off their front; its code is valid and
/// stands in them. Throws std::runtime_error where they begin with none, or not with all of it.
[[nodiscard]] TileView take_tile(std::span<const std::byte>& bytes);

}  // namespace fluxel
