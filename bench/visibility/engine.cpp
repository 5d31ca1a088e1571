#include "bench/visibility/engine.hpp"

#include <algorithm>
#include <iterator>
#include <random>

namespace fluxel::bench {

std::vector<TilePlace> upper_triangle(std::size_t elements) {
  const std::size_t tiles = tile_count(elements);
  std::vector<TilePlace> places;
  places.reserve(tiles * (tiles + 1) / 2);
  for (std::size_t row = 0; row < tiles; ++row)
    for (std::size_t column = row; column < tiles; ++column) places.emplace_back(row, column);
  return places;
}

std::vector<TilePlace> sample_tiles(std::span<const TilePlace> places, std::size_t most) {
  std::vector<TilePlace> sample;
  std::mt19937_64 random(1);
  std::ranges::sample(places, std::back_inserter(sample), static_cast<std::ptrdiff_t>(most), random);
  return sample;
}

void Engine::trace(std::span<const TilePlace> places, std::vector<TracedTile>& tiles) const {
  tiles.resize(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) tiles[k] = tracer.trace(places[k].first, places[k].second);
}

}  // namespace fluxel::bench
