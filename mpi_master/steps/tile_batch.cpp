#include "mpi_master/steps/tile_batch.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "visibility/tile_store.hpp"

namespace fluxel {

void TileBatch::start(std::span<const RowPart> parts) {
  places_.clear();
  for (const RowPart& part : parts)
    for (std::size_t column = part.first; column < part.last; ++column)
      places_.push_back({static_cast<std::uint32_t>(part.row), static_cast<std::uint32_t>(column)});
  tiles_.resize(places_.size());
}

void TileBatch::code(std::size_t first, std::size_t count,
                     const std::function<TracedTile(std::size_t)>& make) {
  std::atomic<std::uint64_t> rays = 0, mixed = 0, code_bytes = 0;
  arena_.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, first + count), [&](const auto& range) {
      std::uint64_t own_rays = 0, own_mixed = 0, own_bytes = 0;
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const TracedTile tile = make(k);
        tiles_[k].tag = tile.tag;
        if (tile.tag == TileTag::bits) {
          tiles_[k].code = encode_tile(tile.bits);
          ++own_mixed;
          own_bytes += TileStore::pool_bytes(tiles_[k].code.size);
        }
        own_rays += tile.rays;
      }
      rays += own_rays;
      mixed += own_mixed;
      code_bytes += own_bytes;
    });
  });
  counts_.rays += rays;
  counts_.mixed += mixed;
  counts_.uniform += count - mixed;
  counts_.code_bytes += code_bytes;
}

void TileBatch::trace(std::size_t first) {
  code(first, places_.size() - first,
       [this](std::size_t k) { return tracer_.trace(places_[k].row, places_[k].column); });
}

}  // namespace fluxel
