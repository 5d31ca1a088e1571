#include "mpi_master/strip_scheduler.hpp"

#include <algorithm>

namespace fluxel {

namespace {

/// Strips a rank: enough that the last one hardly matters, few enough that messages do not.
constexpr std::size_t kStripsPerRank = 32;

}  // namespace

TileRows owned_rows(std::size_t tile_rows, int ranks, int rank) {
  const auto part = static_cast<std::size_t>(rank);
  const auto parts = static_cast<std::size_t>(ranks);
  return {tile_rows * part / parts, tile_rows * (part + 1) / parts};
}

int owner_of(std::size_t tile_rows, int ranks, std::size_t row) {
  // The inverse of the rounding in owned_rows.
  return static_cast<int>(((row + 1) * static_cast<std::size_t>(ranks) - 1) / tile_rows);
}

StripScheduler::StripScheduler(std::size_t tile_rows, int ranks)
    : tile_rows_(tile_rows), left_(static_cast<std::size_t>(ranks)) {
  for (int rank = 0; rank < ranks; ++rank) {
    const TileRows rows = owned_rows(tile_rows, ranks, rank);
    const std::size_t step = std::max<std::size_t>(1, rows.size() / kStripsPerRank);
    std::vector<TileRows>& strips = left_[static_cast<std::size_t>(rank)];
    for (std::size_t first = rows.first; first < rows.last; first += step)
      strips.push_back({first, std::min(first + step, rows.last)});
    std::ranges::reverse(strips);
  }
}

std::optional<TileRows> StripScheduler::next(int rank) {
  std::vector<TileRows>* from = &left_[static_cast<std::size_t>(rank)];
  // Owners stand in the order of their rows, so the first that has strips left has the longest.
  if (from->empty()) {
    const auto owner = std::ranges::find_if(left_, [](const auto& strips) { return !strips.empty(); });
    if (owner == left_.end()) return std::nullopt;
    from = &*owner;
  }
  const TileRows strip = from->back();
  from->pop_back();
  for (std::size_t row = strip.first; row < strip.last; ++row) tiles_dealt_ += tile_rows_ - row;
  return strip;
}

}  // namespace fluxel
