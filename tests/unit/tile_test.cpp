#include "visibility/tile.hpp"

#include <gtest/gtest.h>

#include <random>

namespace fluxel {
namespace {

bool bit(const TileBits& bits, std::size_t row, std::size_t column) {
  return (bits[row] >> column & 1u) != 0;
}

TEST(Tile, TransposeExchangesRowsAndColumns) {
  std::mt19937_64 random(1);
  for (int repeat = 0; repeat < 100; ++repeat) {
    TileBits bits;
    for (std::uint64_t& word : bits) word = random();
    TileBits transposed = bits;
    transpose(transposed);
    for (std::size_t row = 0; row < kTileSize; ++row)
      for (std::size_t column = 0; column < kTileSize; ++column)
        ASSERT_EQ(bit(transposed, column, row), bit(bits, row, column)) << row << ' ' << column;
    transpose(transposed);
    EXPECT_EQ(transposed, bits);
  }
}

TEST(Tile, LowBitsAreAsManyAsAskedFor) {
  for (std::size_t count = 1; count <= kTileSize; ++count) {
    EXPECT_EQ(static_cast<std::size_t>(std::popcount(low_bits(count))), count);
    EXPECT_EQ(static_cast<std::size_t>(std::countr_one(low_bits(count))), count);
  }
}

TEST(Tile, TheLastTileMayBePartlyFilled) {
  EXPECT_EQ(tile_count(0), 0u);
  EXPECT_EQ(tile_count(1), 1u);
  EXPECT_EQ(tile_count(64), 1u);
  EXPECT_EQ(tile_count(65), 2u);
  EXPECT_EQ(rows_of_tile(0, 65), 64u);
  EXPECT_EQ(rows_of_tile(1, 65), 1u);
  EXPECT_EQ(rows_of_tile(1, 128), 64u);
}

}  // namespace
}  // namespace fluxel
