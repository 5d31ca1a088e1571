#include "bench/simulate/pair_work.hpp"

#include <algorithm>

#include "visibility/tile.hpp"

namespace fluxel::bench {

namespace {

constexpr std::uint64_t kPairsPerUnit = kTileSize * kTileSize;
constexpr double kHeaderBytes = 25;  // patches, count and tag

std::uint64_t pairs_of(std::size_t rows, std::size_t columns, bool same) {
  return same ? rows * (rows + 1) / 2 : rows * columns;
}

}  // namespace

PairWork::PairWork(const TracedScene& scene, const RowOwners& owners)
    : scene_(scene), owners_(owners), first_unit_{0}, book_(owners.ranks()) {
  const std::size_t patches = scene.first_element.size() - 1;
  for (std::size_t row = 0; row < patches; ++row) {
    for (std::size_t column = row; column < patches; ++column) {
      const Elements a = patch(row), b = patch(column);
      const std::uint64_t pairs = pairs_of(a.last - a.first, b.last - b.first, row == column);
      row_patch_.push_back(static_cast<std::uint32_t>(row));
      column_patch_.push_back(static_cast<std::uint32_t>(column));
      first_unit_.push_back(first_unit_.back() + (pairs + kPairsPerUnit - 1) / kPairsPerUnit);
    }
  }
}

std::optional<TileRange> PairWork::next(int /*rank*/) {
  if (next_task_ == tasks()) return std::nullopt;
  const std::size_t task = next_task_++;
  return TileRange{first_unit_[task], first_unit_[task + 1]};
}

Batch PairWork::compute(const TileRange& units) {
  const auto task =
      static_cast<std::size_t>(std::ranges::upper_bound(first_unit_, units.first) - first_unit_.begin()) - 1;
  const Elements a = patch(row_patch_[task]), b = patch(column_patch_[task]);
  const bool same = row_patch_[task] == column_patch_[task];
  // Of the task; the map knows tiles above the diagonal.
  double seconds = 0, bytes = 0;
  for (std::size_t row = a.first / kTileSize; row * kTileSize < a.last; ++row) {
    const std::size_t rows = std::min(a.last, (row + 1) * kTileSize) - std::max(a.first, row * kTileSize);
    for (std::size_t column = std::max(row, b.first / kTileSize); column * kTileSize < b.last; ++column) {
      const std::size_t columns =
          std::min(b.last, (column + 1) * kTileSize) - std::max(b.first, column * kTileSize);
      const TileSums tile = scene_.map.sums(row, column, column + 1);
      const double share = static_cast<double>(pairs_of(rows, columns, same && row == column)) /
                           static_cast<double>(pairs_of(kTileSize, kTileSize, row == column));
      seconds += share * tile.seconds;
      bytes += share * tile.bytes;
    }
  }
  const double part =
      static_cast<double>(units.size()) / static_cast<double>(first_unit_[task + 1] - first_unit_[task]);
  hand_over(a, kHeaderBytes + part * bytes);
  if (!same) hand_over(b, kHeaderBytes + part * bytes);
  return {part * seconds, book_.take()};
}

/// To the owners of these elements, each its part.
void PairWork::hand_over(const Elements& to, double bytes) {
  for (std::size_t first = to.first; first < to.last;) {
    const int owner = owners_.owner(first / kTileSize);
    const std::size_t last = std::min(to.last, owners_.rows(owner).last * kTileSize);
    const double share = static_cast<double>(last - first) / static_cast<double>(to.last - to.first);
    book_.add(owner, 1, share * bytes);
    first = last;
  }
}

}  // namespace fluxel::bench
