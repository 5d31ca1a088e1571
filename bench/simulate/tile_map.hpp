#pragma once

#include <cstddef>
#include <vector>

namespace fluxel::bench {

/// Tiles of a part of the matrix, by a sample: means of a tile.
struct TileBlock {
  double seconds = 0;    ///< to trace and code
  double deviation = 0;  ///< of the seconds: their standard deviation
  double mixed = 0;      ///< share of tiles with bits
  double visible = 0;    ///< share of tiles of which all pairs see each other
  double bytes = 0;      ///< of the code
};

struct TileSums {
  double seconds = 0, variance = 0, bytes = 0, lit = 0;
};

/// What the tiles of a real scene cost, measured once: the matrix in blocks, from which the cost of any tiles
/// follows.
class TileMap {
 public:
  TileMap() = default;
  /// `blocks_on_side` at most `side`, the tiles on the matrix' side.
  TileMap(std::size_t side, std::size_t blocks_on_side);

  [[nodiscard]] std::size_t side() const { return side_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_; }
  /// First tile row, or column, of a block; side() for the one behind the last.
  [[nodiscard]] std::size_t first_of_block(std::size_t block) const { return side_ * block / blocks_; }
  [[nodiscard]] std::size_t block_of(std::size_t row) const { return ((row + 1) * blocks_ - 1) / side_; }

  /// Of the tiles in block row `row`, block column `column` >= row.
  [[nodiscard]] TileBlock& at(std::size_t row, std::size_t column) { return table_[row * blocks_ + column]; }
  [[nodiscard]] const TileBlock& at(std::size_t row, std::size_t column) const {
    return table_[row * blocks_ + column];
  }

  /// To be called when all blocks are set.
  void finish();

  /// The tiles (row, first ... last - 1), first >= row.
  [[nodiscard]] TileSums sums(std::size_t row, std::size_t first, std::size_t last) const;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(side_, blocks_, table_);
  }

 private:
  [[nodiscard]] TileSums before(std::size_t block_row, std::size_t column) const;

  std::size_t side_ = 0, blocks_ = 0;
  std::vector<TileBlock> table_;
  std::vector<TileSums> before_;  // by block row: sums over the columns before each block
};

template <class Archive>
void serialize(Archive& archive, TileBlock& block) {
  archive(block.seconds, block.deviation, block.mixed, block.visible, block.bytes);
}

}  // namespace fluxel::bench
