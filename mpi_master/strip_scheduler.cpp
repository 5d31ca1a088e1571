#include "mpi_master/strip_scheduler.hpp"

#include <algorithm>

namespace fluxel {

namespace {

/// Of the rows that an owner has left. Strips shrink, so that ranks end together however dear the last rows
/// are (Polychronopoulos & Kuck, Guided self-scheduling, 1987), and are few enough that messages do not
/// matter.
constexpr std::size_t kShare = 32;

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

StripScheduler::StripScheduler(std::size_t tile_rows, int ranks) : tile_rows_(tile_rows) {
  for (int rank = 0; rank < ranks; ++rank) left_.push_back(owned_rows(tile_rows, ranks, rank));
}

std::optional<TileRows> StripScheduler::next(int rank) {
  TileRows* from = &left_[static_cast<std::size_t>(rank)];
  // Owners stand in the order of their rows, so the first that has rows left has the longest.
  if (from->size() == 0) {
    const auto owner = std::ranges::find_if(left_, [](const TileRows& rows) { return rows.size() > 0; });
    if (owner == left_.end()) return std::nullopt;
    from = &*owner;
  }
  const TileRows strip{from->first, from->first + std::max<std::size_t>(1, from->size() / kShare)};
  from->first = strip.last;
  for (std::size_t row = strip.first; row < strip.last; ++row) tiles_dealt_ += tile_rows_ - row;
  return strip;
}

}  // namespace fluxel
