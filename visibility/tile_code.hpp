#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "visibility/tile.hpp"

namespace fluxel {

/// A tile's bits in fewer bytes. Neighbouring elements mostly see the same elements of another tile, so many
/// of its rows are alike, and many of its columns: a code keeps every different row and column once. Bit
/// after bit, lowest first:
///
/// * 6 bits each: different rows - 1, different columns - 1;
/// * the map of rows, then that of columns; none where all 64 count as different. A map is
///   63 bits: line 1, 2 ... differs from the one before it; for each that does, a bit: it is like none
///   before; for each that does and is like an earlier one, the number of that among the different ones, in
///   as few bits as name them all;
/// * a bit for each different row and column, column after column.
///
/// Where the maps take more than they save, all rows and columns count as different: raw bits.
struct TileCode {
  /// decode_tile may read this many bytes beyond a code.
  static constexpr std::size_t kPadding = 8;
  static constexpr std::size_t kMaxBytes = 2 + sizeof(TileBits);

  std::array<std::byte, kMaxBytes + kPadding> bytes{};
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::byte> view() const { return std::span(bytes).first(size); }
};

/// The same bits give the same code.
[[nodiscard]] TileCode encode_tile(const TileBits& bits);

/// The tile whose code, valid and with kPadding readable bytes behind it, begins at `code`.
void decode_tile(const std::byte* code, TileBits& bits);

/// Size of the code that `bytes`, from wherever they come, begin with [bytes]. Throws std::runtime_error
/// where they begin with none, or not with all of it.
[[nodiscard]] std::size_t checked_code_size(std::span<const std::byte> bytes);

}  // namespace fluxel
