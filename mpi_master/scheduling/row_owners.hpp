#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "visibility/tile_store.hpp"

namespace fluxel {

/// Which rank owns which tile rows: ranks in ascending order have ranges one after another, some perhaps
/// empty.
class RowOwners {
 public:
  /// Ranges of about the same cost; the costs, none of them negative, are those of a whole row, all columns,
  /// in any unit. The same costs give the same ranges.
  RowOwners(std::span<const double> row_costs, int ranks);

  [[nodiscard]] int ranks() const { return static_cast<int>(first_.size()) - 1; }
  [[nodiscard]] std::size_t tile_rows() const { return first_.back(); }

  [[nodiscard]] TileRows rows(int rank) const {
    const auto at = static_cast<std::size_t>(rank);
    return {first_[at], first_[at + 1]};
  }
  /// The rank that owns a tile row.
  [[nodiscard]] int owner(std::size_t row) const {
    return static_cast<int>(std::ranges::upper_bound(first_, row) - first_.begin()) - 1;
  }

 private:
  std::vector<std::size_t> first_;  // by rank, and the end
};

}  // namespace fluxel
