#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "visibility/tile_store.hpp"

namespace fluxel {

/// The tile rows that a rank owns: an even split, ranks in ascending order; ranks beyond the rows own none.
[[nodiscard]] TileRows owned_rows(std::size_t tile_rows, int ranks, int rank);

/// The rank that owns a tile row.
[[nodiscard]] int owner_of(std::size_t tile_rows, int ranks, std::size_t row);

/// Rank 0's decisions: which strip of the visibility matrix, all tiles (row, column >= row) of some rows, a
/// rank computes next. Knows nothing of messages.
class StripScheduler {
 public:
  StripScheduler(std::size_t tile_rows, int ranks);

  /// The next strip for a rank that has nothing to do: from the top of its own rows, whose tiles need not
  /// travel, else of those of the first rank that has some left; the fewer are left the smaller. Nothing when
  /// all rows are dealt.
  [[nodiscard]] std::optional<TileRows> next(int rank);

  [[nodiscard]] std::size_t tiles_dealt() const { return tiles_dealt_; }
  [[nodiscard]] std::size_t tiles_in_all() const { return tile_rows_ * (tile_rows_ + 1) / 2; }

 private:
  std::size_t tile_rows_;
  std::vector<TileRows> left_;  // by owner; rows on top of the triangle are longest
  std::size_t tiles_dealt_ = 0;
};

}  // namespace fluxel
