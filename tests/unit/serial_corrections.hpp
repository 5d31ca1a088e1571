#pragma once

#include "formfactor/tile_examiner.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel::test_scenes {

/// All that is to be corrected, one tile after another, without asking which have work.
inline TileExaminer::Found examine_all(const TileExaminer& examiner, const TileStore& store) {
  TileExaminer::Found found;
  for (std::size_t row = 0; row < store.tiles(); ++row) {
    for (std::size_t column = row; column < store.tiles(); ++column) {
      TileBits bits;
      store.read(row, column, bits);
      examiner.examine(row, column, bits, 0, kTileSize, found);
    }
  }
  return found;
}

}  // namespace fluxel::test_scenes
