#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace fluxel {

/// Consecutive tiles, [first, last), by their numbers in a TileTriangle.
struct TileRange {
  std::uint64_t first = 0, last = 0;

  [[nodiscard]] std::uint64_t size() const { return last - first; }
  bool operator==(const TileRange&) const = default;
};

/// The tiles (row, column >= row) of the visibility matrix, numbered row after row from the diagonal. Any
/// work that is assigned or kept is a range of these numbers, whatever rows it begins and ends in.
class TileTriangle {
 public:
  /// `side`: tiles on the side of the whole matrix, below 2^32.
  explicit TileTriangle(std::size_t side) : side_(side) {}

  [[nodiscard]] std::size_t side() const { return side_; }
  [[nodiscard]] std::uint64_t size() const { return first_of(side_); }

  /// The number of tile (row, row).
  [[nodiscard]] std::uint64_t first_of(std::uint64_t row) const {
    return row * side_ - row * (row - (row > 0 ? 1 : 0)) / 2;
  }
  [[nodiscard]] std::uint64_t number(std::size_t row, std::size_t column) const {
    return first_of(row) + (column - row);
  }

  /// The row of a tile; side() for the number behind the last.
  [[nodiscard]] std::size_t row_of(std::uint64_t number) const {
    // The root of the quadratic first_of, then the last step exact.
    const double b = static_cast<double>(side_) + 0.5;
    const double root = b - std::sqrt(std::max(0.0, b * b - 2.0 * static_cast<double>(number)));
    auto row = static_cast<std::uint64_t>(std::clamp(root, 0.0, static_cast<double>(side_)));
    while (row > 0 && first_of(row) > number) --row;
    while (row < side_ && first_of(row + 1) <= number) ++row;
    return row;
  }
  [[nodiscard]] std::size_t column_of(std::size_t row, std::uint64_t number) const {
    return row + static_cast<std::size_t>(number - first_of(row));
  }

 private:
  std::uint64_t side_;
};

}  // namespace fluxel
