#pragma once

#include <tbb/task_arena.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mpi_master/communication/row_parts.hpp"
#include "mpi_master/scheduling/tile_messages.hpp"
#include "visibility/cuda/tile_scene.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {

/// Of all tiles that a rank has made.
struct TileBatchCounts {
  std::uint64_t rays = 0;
  std::uint64_t uniform = 0, mixed = 0;  ///< tiles
  std::uint64_t code_bytes = 0;          ///< of the mixed ones
};

/// Tiles that a rank makes together, one batch after another, and codes by all of its threads.
class TileBatch {
 public:
  TileBatch(const TileTracer& tracer, int threads) : tracer_(tracer), arena_(threads) {}

  /// The tiles of these parts of rows, none of which is made yet.
  void start(std::span<const RowPart> parts);
  /// Codes the tiles [first, first + count), which `make` makes; of several threads at a time.
  void code(std::size_t first, std::size_t count, const std::function<TracedTile(std::size_t)>& make);
  /// Traces and codes the tiles from `first` on.
  void trace(std::size_t first);

  [[nodiscard]] const std::vector<cuda::TilePlace>& places() const { return places_; }
  [[nodiscard]] std::span<const CodedTile> tiles() const { return tiles_; }
  [[nodiscard]] const TileBatchCounts& counts() const { return counts_; }

 private:
  const TileTracer& tracer_;
  tbb::task_arena arena_;
  std::vector<cuda::TilePlace> places_;
  std::vector<CodedTile> tiles_;
  TileBatchCounts counts_;
};

}  // namespace fluxel
