#include "bench/simulate/trace_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "bench/visibility/scenes.hpp"
#include "bench/visibility/stopwatch.hpp"
#include "core/error.hpp"
#include "visibility/ray_scene.hpp"
#include "visibility/tile_code.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel::bench {

namespace {

SceneSource source_of(const TraceSettings& settings) {
  for (const SceneSource& source : scene_sources(settings.large_scenes))
    if (source.name == settings.scene) return source;
  throw InputError(fmt::format("no scene of the benchmark is named '{}'", settings.scene));
}

/// What reading the thread's clock takes [s]: no less than many tiles.
double clock_seconds() {
  constexpr int kReadings = 1000;
  static const double seconds = thread_seconds_of([] {
                                  for (int k = 0; k < kReadings; ++k) thread_seconds_of([] {});
                                }) /
                                kReadings;
  return seconds;
}

/// Sums over the tiles of a block.
class BlockSample {
 public:
  void add(const TileTracer& tracer, std::size_t row, std::size_t column) {
    TracedTile tile;
    std::size_t bytes = 0;
    const double taken = thread_seconds_of([&] {
      tile = tracer.trace(row, column);
      if (tile.tag == TileTag::bits) bytes = encode_tile(tile.bits).size;
    });
    const double seconds = std::max(0.0, taken - clock_seconds() / 2);
    ++tiles_;
    seconds_ += seconds;
    squared_seconds_ += seconds * seconds;
    mixed_ += tile.tag == TileTag::bits;
    visible_ += tile.tag == TileTag::visible;
    bytes_ += static_cast<double>(bytes);
  }

  [[nodiscard]] TileBlock means() const {
    const double mean = seconds_ / tiles_;
    return {mean, std::sqrt(std::max(0.0, squared_seconds_ / tiles_ - mean * mean)), mixed_ / tiles_,
            visible_ / tiles_, bytes_ / tiles_};
  }

 private:
  double tiles_ = 0, seconds_ = 0, squared_seconds_ = 0, mixed_ = 0, visible_ = 0, bytes_ = 0;
};

/// Of the block's tiles on and above the diagonal.
TileBlock sample_block(const TileTracer& tracer, const TileMap& map, std::size_t block_row,
                       std::size_t block_column, std::size_t most, std::mt19937_64& random) {
  const std::size_t first_row = map.first_of_block(block_row),
                    rows = map.first_of_block(block_row + 1) - first_row;
  const std::size_t first_column = map.first_of_block(block_column);
  const std::size_t columns = map.first_of_block(block_column + 1) - first_column;
  BlockSample sample;
  if (rows * columns <= most) {
    for (std::size_t row = first_row; row < first_row + rows; ++row)
      for (std::size_t column = std::max(row, first_column); column < first_column + columns; ++column)
        sample.add(tracer, row, column);
    return sample.means();
  }
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t row = first_row + random() % rows, column = first_column + random() % columns;
    sample.add(tracer, std::min(row, column), std::max(row, column));
  }
  return sample.means();
}

/// Patches stand in the elements' order.
std::vector<std::size_t> patch_starts(const std::vector<Element>& elements) {
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (i == 0 || elements[i].patch != elements[i - 1].patch) first.push_back(i);
  first.push_back(elements.size());
  return first;
}

}  // namespace

TracedScene trace_scene(const Communicator& alone, const TraceSettings& settings) {
  const Scene scene = load_scene(source_of(settings), false).scene;
  const ElementMesh mesh = subdivide_to_size(scene, settings.elements);
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, mesh.elements);

  TracedScene traced;
  traced.name = settings.scene;
  traced.elements = mesh.elements.size();
  traced.first_element = patch_starts(mesh.elements);
  traced.costs = sample_tiles(alone, tracer, 1).costs;
  traced.map = TileMap(tile_count(mesh.elements.size()), settings.blocks);
  std::mt19937_64 random(1);
  for (std::size_t row = 0; row < traced.map.blocks(); ++row)
    for (std::size_t column = row; column < traced.map.blocks(); ++column)
      traced.map.at(row, column) =
          sample_block(tracer, traced.map, row, column, settings.tiles_per_block, random);
  traced.map.finish();
  double seconds = 0;
  for (std::size_t row = 0; row < traced.map.side(); ++row)
    seconds += traced.map.sums(row, row, traced.map.side()).seconds;
  fmt::print("{}, {} elements: {:.3g} s to trace, forecast {:.3g} s\n", traced.name, traced.elements, seconds,
             std::accumulate(traced.costs.trace.begin(), traced.costs.trace.end(), 0.0));
  return traced;
}

}  // namespace fluxel::bench
