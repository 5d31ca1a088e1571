#pragma once

#include <algorithm>
#include <vector>

#include "visibility/tile_range.hpp"

namespace fluxel {

/// Columns [first, last) of a row of tiles, and the place of the first in a batch.
struct RowPart {
  std::size_t row, first, last, batch_first;

  [[nodiscard]] std::size_t size() const { return last - first; }

  bool operator==(const RowPart&) const = default;
};

/// The tiles of a range, row after row.
[[nodiscard]] inline std::vector<RowPart> row_parts(const TileTriangle& triangle, const TileRange& range) {
  std::vector<RowPart> parts;
  for (std::uint64_t first = range.first; first < range.last;) {
    const std::size_t row = triangle.row_of(first);
    const std::uint64_t last = std::min(range.last, triangle.first_of(row + 1));
    const std::size_t column = triangle.column_of(row, first);
    parts.push_back({row, column, column + static_cast<std::size_t>(last - first),
                     static_cast<std::size_t>(first - range.first)});
    first = last;
  }
  return parts;
}

}  // namespace fluxel
