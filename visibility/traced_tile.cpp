#include "visibility/traced_tile.hpp"

#include <algorithm>
#include <span>

namespace fluxel {

namespace {

void mirror(TileBits& bits) {
  TileBits mirrored = bits;
  transpose(mirrored);
  for (std::size_t r = 0; r < kTileSize; ++r) bits[r] |= mirrored[r];
}

TileTag tag_of(const TileBits& bits, std::size_t rows, std::size_t columns) {
  const auto row_words = std::span(bits).first(rows);
  const auto all = [row_words](std::uint64_t wanted) {
    return std::ranges::all_of(row_words, [wanted](std::uint64_t word) { return word == wanted; });
  };
  return all(0) ? TileTag::blocked : all(low_bits(columns)) ? TileTag::visible : TileTag::bits;
}

}  // namespace

void complete_tile(std::size_t row, std::size_t column, std::size_t elements, TracedTile& tile) {
  if (row == column) mirror(tile.bits);
  tile.tag = tag_of(tile.bits, rows_of_tile(row, elements), rows_of_tile(column, elements));
}

}  // namespace fluxel
