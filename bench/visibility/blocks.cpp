#include "bench/visibility/blocks.hpp"

#include <algorithm>

namespace fluxel::bench {

void count_blocks(const TileBits& bits, std::size_t rows, std::size_t columns, std::size_t size,
                  double weight, BlockCount& count) {
  for (std::size_t row = 0; row < rows; row += size) {
    std::uint64_t any = 0, all = low_bits(columns);
    for (std::size_t r = row; r < std::min(row + size, rows); ++r) {
      any |= bits[r];
      all &= bits[r];
    }
    for (std::size_t column = 0; column < columns; column += size) {
      const std::uint64_t block = low_bits(std::min(size, columns - column)) << column;
      count.blocks += weight;
      if ((any & block) != 0 && (all & block) != block) count.mixed += weight;
    }
  }
}

}  // namespace fluxel::bench
