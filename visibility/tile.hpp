#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace fluxel {

/// Elements on a tile's side; a row of a tile is one 64-bit word.
inline constexpr std::size_t kTileSize = 64;

/// Word r, bit c: the pair (row r, column c) of the tile sees each other.
using TileBits = std::array<std::uint64_t, kTileSize>;

/// A tile that has one value for all its pairs needs no bits.
enum class TileTag : std::uint8_t {
  blocked,      ///< no pair sees each other, and rays were needed to know
  facing_away,  ///< no pair has unknown sides that face each other
  visible,      ///< every pair sees each other
  bits
};

/// Tiles on the side of a matrix of this many elements.
constexpr std::size_t tile_count(std::size_t elements) { return (elements + kTileSize - 1) / kTileSize; }

/// Rows (or columns) of the last tile may be fewer than 64.
constexpr std::size_t rows_of_tile(std::size_t tile, std::size_t elements) {
  const std::size_t first = tile * kTileSize;
  return elements - first < kTileSize ? elements - first : kTileSize;
}

/// A word with the lowest `count` bits set, count in 1..64.
constexpr std::uint64_t low_bits(std::size_t count) { return ~std::uint64_t{0} >> (kTileSize - count); }

/// One step of transpose, for what the first `rows` rows need: exchanges neighbouring squares of `width` that
/// lie off the diagonal. The inner loop has a fixed length, so that several rows are done at once.
template <std::size_t width>
constexpr void exchange_squares(TileBits& bits, std::size_t rows) {
  constexpr std::uint64_t kLowerHalves = ~std::uint64_t{0} / ((std::uint64_t{1} << width) + 1);
  for (std::size_t first = 0; first < rows; first += 2 * width) {
    for (std::size_t row = first; row < first + width; ++row) {
      const std::uint64_t swapped = ((bits[row] >> width) ^ bits[row + width]) & kLowerHalves;
      bits[row] ^= swapped << width;
      bits[row + width] ^= swapped;
    }
  }
}

/// Rows become columns; in place, by exchanging ever smaller squares (Warren, Hacker's Delight, 2002, 7-3).
/// Where only the first `rows` rows of the result are needed, the others are left anyhow.
constexpr void transpose(TileBits& bits, std::size_t rows = kTileSize) {
  exchange_squares<32>(bits, rows);
  exchange_squares<16>(bits, rows);
  exchange_squares<8>(bits, rows);
  exchange_squares<4>(bits, rows);
  exchange_squares<2>(bits, rows);
  exchange_squares<1>(bits, rows);
}

}  // namespace fluxel
