#pragma once

#include <algorithm>
#include <vector>

#include "visibility/tile_store.hpp"

namespace fluxel {

/// Columns [first, last) of a row of tiles, and the place of the first in a batch.
struct RowPart {
  std::size_t row, first, last, batch_first;

  [[nodiscard]] std::size_t size() const { return last - first; }
  [[nodiscard]] std::size_t batch_last() const { return batch_first + size(); }

  bool operator==(const RowPart&) const = default;
};

/// Goes through a strip, the tiles (row, column >= row) of some rows, in batches that pay no heed to rows.
class StripWalk {
 public:
  StripWalk() = default;
  /// `tiles`: columns of the whole matrix.
  StripWalk(const TileRows& strip, std::size_t tiles) : left_(strip), tiles_(tiles), column_(strip.first) {}

  [[nodiscard]] bool done() const { return left_.size() == 0; }

  /// The next `most` tiles, or what is left.
  [[nodiscard]] std::vector<RowPart> next(std::size_t most) {
    std::vector<RowPart> parts;
    std::size_t count = 0;
    while (!done() && count < most) {
      parts.push_back({left_.first, column_, std::min(tiles_, column_ + most - count), count});
      count = parts.back().batch_last();
      column_ = parts.back().last;
      if (column_ == tiles_) column_ = ++left_.first;
    }
    return parts;
  }

 private:
  TileRows left_;
  std::size_t tiles_ = 0;
  std::size_t column_ = 0;
};

}  // namespace fluxel
