#include "formfactor/sampled_entries.hpp"

namespace fluxel {

namespace {

/// With more parts than a tile has lines most chances choose none.
constexpr std::size_t kMaxParts = 64 * kTileSize;

}  // namespace

std::uint64_t sampled_entries(const TileExaminer& examiner, std::size_t row, std::size_t column,
                              const TracedTile& tile, double seconds, std::uint64_t chance) {
  if (!examiner.has_work(row, column)) return 0;
  const double of_tile = examiner.predicted_seconds(row, column, tile.tag);
  std::size_t parts = 1;
  while (parts < kMaxParts && of_tile > seconds * static_cast<double>(parts)) parts *= 2;
  TileExaminer::Found found;
  // Near pairs stand together: lines that are spread tell more of them than as many beside each other.
  for (std::size_t line = chance % parts; line < kTileSize; line += parts)
    examiner.examine(row, column, tile.bits, line, line + 1, found);
  return found.entries.size() * parts;
}

}  // namespace fluxel
