#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/element.hpp"
#include "visibility/ray_scene.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel::bench {

/// (row, column) of a tile, column >= row.
using TilePlace = std::pair<std::size_t, std::size_t>;

/// All tiles on and above the diagonal, row by row.
[[nodiscard]] std::vector<TilePlace> upper_triangle(std::size_t elements);

/// As many of them by chance, with a fixed seed and in their order; all where they are no more than that.
[[nodiscard]] std::vector<TilePlace> sample_tiles(std::span<const TilePlace> places, std::size_t most);

/// The visibility engine as the benchmark sees it: the one place that calls it.
struct Engine {
  const RayScene& ray_scene;
  std::span<const Element> elements;
  TileTracer tracer{ray_scene, elements};

  /// The tiles at `places`, in that order.
  void trace(std::span<const TilePlace> places, std::vector<TracedTile>& tiles) const;
};

}  // namespace fluxel::bench
