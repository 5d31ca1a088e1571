#include "bench/simulate/tile_map.hpp"

#include <algorithm>

namespace fluxel::bench {

TileMap::TileMap(std::size_t side, std::size_t blocks_on_side)
    : side_(side), blocks_(std::min(side, blocks_on_side)), table_(blocks_ * blocks_) {}

void TileMap::finish() {
  before_.assign(blocks_ * (blocks_ + 1), {});
  for (std::size_t row = 0; row < blocks_; ++row) {
    for (std::size_t column = row; column < blocks_; ++column) {
      const TileBlock& block = at(row, column);
      const auto tiles = static_cast<double>(first_of_block(column + 1) - first_of_block(column));
      const TileSums& sums = before_[row * (blocks_ + 1) + column];
      before_[row * (blocks_ + 1) + column + 1] = {
          sums.seconds + tiles * block.seconds, sums.variance + tiles * block.deviation * block.deviation,
          sums.bytes + tiles * block.bytes, sums.lit + tiles * (block.mixed + block.visible)};
    }
  }
}

TileSums TileMap::before(std::size_t block_row, std::size_t column) const {
  if (column == side_) return before_[block_row * (blocks_ + 1) + blocks_];
  const std::size_t block_column = block_of(column);
  const TileSums& sums = before_[block_row * (blocks_ + 1) + block_column];
  const TileBlock& block = at(block_row, block_column);
  const auto tiles = static_cast<double>(column - first_of_block(block_column));
  return {sums.seconds + tiles * block.seconds, sums.variance + tiles * block.deviation * block.deviation,
          sums.bytes + tiles * block.bytes, sums.lit + tiles * (block.mixed + block.visible)};
}

TileSums TileMap::sums(std::size_t row, std::size_t first, std::size_t last) const {
  const std::size_t block_row = block_of(row);
  const TileSums low = before(block_row, first), high = before(block_row, last);
  return {high.seconds - low.seconds, high.variance - low.variance, high.bytes - low.bytes,
          high.lit - low.lit};
}

}  // namespace fluxel::bench
