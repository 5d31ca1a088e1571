#pragma once

#include <cstddef>

#include "visibility/tile.hpp"

namespace fluxel::bench {

/// Square blocks of a matrix of bits, and those that hold both values.
struct BlockCount {
  double blocks = 0;
  double mixed = 0;

  [[nodiscard]] double fraction() const { return blocks > 0 ? mixed / blocks : 0; }
};

/// Adds the blocks of `size` x `size` pairs (a divisor of 64) of a tile of `rows` x `columns` pairs, `weight`
/// times. A block at the matrix's end counts with the pairs that it has.
void count_blocks(const TileBits& bits, std::size_t rows, std::size_t columns, std::size_t size,
                  double weight, BlockCount& count);

}  // namespace fluxel::bench
