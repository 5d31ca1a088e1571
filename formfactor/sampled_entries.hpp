#pragma once

#include <cstdint>

#include "formfactor/tile_examiner.hpp"
#include "visibility/traced_tile.hpp"

namespace fluxel {

/// About how many entries the corrections of tile (row, column >= row) come to, in both directions. Where all
/// of its lines take longer than about `seconds`, some lines, which `chance` chooses, stand for the others
/// (or none, of a tile of which one line takes longer): over all values of `chance` the mean is exact.
[[nodiscard]] std::uint64_t sampled_entries(const TileExaminer& examiner, std::size_t row, std::size_t column,
                                            const TracedTile& tile, double seconds, std::uint64_t chance);

}  // namespace fluxel
