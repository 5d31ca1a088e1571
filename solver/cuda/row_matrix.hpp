#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "solver/cuda/row_view.hpp"

namespace fluxel::cuda {

/// What is known of a tile before its bits are asked for.
struct TileSummary {
  enum class Seen : std::uint8_t { nothing, all, some } seen;
  bool far;  ///< Rule::point is enough for its pairs
};

/// A matrix's size and rule, and the tile rows of it that are gathered.
struct RowShape {
  Rule rule;
  bool two_sided;
  std::uint32_t tiles;                ///< on the matrix's side
  std::uint32_t first_row, last_row;  ///< [first, last)
};

/// Rows of the matrix as a device takes them, once, when it is made; the bits come tile row by tile row, so
/// that they are never held in one piece here.
class RowMatrix {
 public:
  using SummaryOf = std::function<TileSummary(std::uint32_t row, std::uint32_t column)>;
  using ReadBits = std::function<void(std::uint32_t row, std::uint32_t column, std::uint64_t* words)>;

  /// `columns`: of each tile kColumnLines lines, which must outlive this. Both functions are asked for
  /// (row, column) with row <= column, one of which is a row of the shape; a tile's bits are words of its
  /// rows. Throws std::length_error for more tiles with bits than an entry can name (2^31, a terabyte).
  RowMatrix(const RowShape& shape, const float* columns, const SummaryOf& summary_of, ReadBits read_bits);

  [[nodiscard]] const RowShape& shape() const { return shape_; }
  [[nodiscard]] std::uint32_t rows() const { return shape_.last_row - shape_.first_row; }
  [[nodiscard]] const float* columns() const { return columns_; }
  [[nodiscard]] std::size_t column_numbers() const {
    return std::size_t{shape_.tiles} * kColumnLines * kTile;
  }
  /// As in RowView.
  [[nodiscard]] const std::vector<TileEntry>& entries() const { return entries_; }

  /// Tiles of bits in all, and those before the ones that `read_row` gives of a row.
  [[nodiscard]] std::size_t tiles_with_bits() const { return first_bits_.back(); }
  [[nodiscard]] std::size_t first_bits(std::uint32_t row) const {
    return first_bits_[row - shape_.first_row];
  }
  /// Writes the words of the tiles of bits that are kept with a row, each tile being kept once; returns how
  /// many tiles, at most shape().tiles.
  std::size_t read_row(std::uint32_t row, std::uint64_t* words) const;

 private:
  [[nodiscard]] bool is_kept_with(std::uint32_t row, std::uint32_t column) const;

  RowShape shape_;
  const float* columns_;
  ReadBits read_bits_;
  std::vector<TileEntry> entries_;
  std::vector<std::size_t> first_bits_;  // of each row, then of all
};

/// Lines of power and of sums a tile, with the most channels.
[[nodiscard]] std::uint32_t most_lines(const RowShape& shape);

/// Tile rows that are gathered by one launch: their slices fill a large device several times, and bound the
/// memory of the slices' sums.
[[nodiscard]] std::uint32_t rows_at_once(const RowShape& shape);

/// What a device needs for the matrix, its vectors and what it computes with [bytes].
[[nodiscard]] std::size_t device_bytes(const RowMatrix& matrix);

/// Throws DeviceError where that is more than `memory` bytes.
void require_room(const RowMatrix& matrix, std::size_t memory);

}  // namespace fluxel::cuda
