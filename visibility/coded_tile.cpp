#include "visibility/coded_tile.hpp"

#include <stdexcept>

#include "visibility/tile_code.hpp"

namespace fluxel {

void append_tile(std::vector<std::byte>& bytes, const TileView& tile) {
  bytes.push_back(static_cast<std::byte>(tile.tag));
  if (tile.tag == TileTag::bits) bytes.insert(bytes.end(), tile.code.begin(), tile.code.end());
}

TileView take_tile(std::span<const std::byte>& bytes) {
  if (bytes.empty()) throw std::runtime_error("a visibility tile is missing");
  if (bytes.front() > static_cast<std::byte>(TileTag::bits))
    throw std::runtime_error("a visibility tile has an unknown tag");
  TileView tile{static_cast<TileTag>(bytes.front()), {}};
  bytes = bytes.subspan(1);
  if (tile.tag != TileTag::bits) return tile;
  tile.code = bytes.first(checked_code_size(bytes));
  bytes = bytes.subspan(tile.code.size());
  return tile;
}

}  // namespace fluxel
