#include "bench/visibility/measure.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

#include "bench/visibility/blocks.hpp"
#include "bench/visibility/classical.hpp"
#include "bench/visibility/engine.hpp"
#include "bench/visibility/raw_packets.hpp"
#include "bench/visibility/stopwatch.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel::bench {

namespace {

constexpr std::size_t kBatch = 64;  // tiles between two changes from the engine to raw packets

std::uint64_t visible_pairs(const TracedTile& tile, bool diagonal) {
  std::uint64_t visible = 0;
  for (const std::uint64_t word : tile.bits) visible += static_cast<std::uint64_t>(std::popcount(word));
  return diagonal ? visible / 2 : visible;
}

/// What the answers say, gathered once.
class Statistics {
 public:
  explicit Statistics(std::size_t elements)
      : elements_(elements), store_(tile_count(elements), {0, tile_count(elements)}) {
    empty_bytes_ = store_.bytes();
  }

  void add(const TilePlace& place, const TracedTile& tile) {
    const std::size_t rows = rows_of_tile(place.first, elements_);
    const std::size_t columns = rows_of_tile(place.second, elements_);
    const double weight = place.first == place.second ? 1 : 2;
    count_blocks(tile.bits, rows, columns, 8, weight, blocks_8_);
    count_blocks(tile.bits, rows, columns, 4, weight, blocks_4_);
    tiles_ += 1;
    without_rays_ += tile.rays == 0;
    one_value_ += tile.tag != TileTag::bits;
    rays_ += static_cast<double>(tile.rays);
    store_.put(place.first, place.second, tile.tag, tile.bits);
  }

  /// `scale`: tiles of the upper triangle over tiles added.
  void write(double scale, Measurement& result) const {
    const auto n = static_cast<double>(elements_);
    const auto empty = static_cast<double>(empty_bytes_);
    result.without_rays = without_rays_ / tiles_;
    result.one_value = one_value_ / tiles_;
    result.mixed_8 = blocks_8_.fraction();
    result.mixed_4 = blocks_4_.fraction();
    result.rays_a_pair = rays_ * scale / (n * n);
    result.bits_a_pair = 8 * (empty + scale * (static_cast<double>(store_.bytes()) - empty)) / (n * n);
  }

 private:
  std::size_t elements_;
  TileStore store_;
  std::size_t empty_bytes_ = 0;
  BlockCount blocks_8_, blocks_4_;
  double tiles_ = 0, without_rays_ = 0, one_value_ = 0, rays_ = 0;
};

/// A plain loop of packets.
struct RawLoop {
  const RawEmbree& embree;
  bool robust;
  std::size_t block;
  bool coherent;
};

struct Repetition {
  double engine_seconds = 0;
  std::vector<double> raw_seconds;  ///< of each loop
  std::uint64_t raw_rays = 0;
  std::uint64_t differing = 0;  ///< from the first loop
};

/// The engine over all places, raw loops over those that are also in `raw_places` (in the same order).
Repetition repeat(const Engine& engine, std::span<const RawLoop> loops, std::span<const TilePlace> places,
                  std::span<const TilePlace> raw_places, Statistics* statistics, Progress& progress) {
  Repetition result;
  result.raw_seconds.resize(loops.size());
  std::vector<TracedTile> tiles;
  TilePackets packets;
  auto raw = raw_places.begin();
  for (std::size_t first = 0; first < places.size(); first += kBatch) {
    const auto batch = places.subspan(first, std::min(kBatch, places.size() - first));
    result.engine_seconds += thread_seconds_of([&] { engine.trace(batch, tiles); });
    for (std::size_t k = 0; k < batch.size(); ++k) {
      if (statistics != nullptr) statistics->add(batch[k], tiles[k]);
      if (raw == raw_places.end() || *raw != batch[k]) continue;
      const TilePlace& place = *raw++;
      for (std::size_t l = 0; l < loops.size(); ++l) {
        const RawLoop& loop = loops[l];
        pack_tile(engine.ray_scene.surface_epsilon(), engine.elements, place, loop.block, packets);
        std::uint64_t seen = 0;
        result.raw_seconds[l] += thread_seconds_of([&] { seen = loop.embree.trace(packets, loop.coherent); });
        if (l > 0) continue;
        result.raw_rays += packets.rays;
        const std::uint64_t visible = visible_pairs(tiles[k], place.first == place.second);
        result.differing += std::max(seen, visible) - std::min(seen, visible);
      }
    }
    progress.update(static_cast<double>(first + batch.size()), static_cast<double>(places.size()));
  }
  return result;
}

/// Of the fastest loop [rays/s].
double raw_rate(const Repetition& repetition, std::span<const RawLoop> loops, bool robust) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t l = 0; l < loops.size(); ++l)
    if (loops[l].robust == robust) least = std::min(least, repetition.raw_seconds[l]);
  return static_cast<double>(repetition.raw_rays) / least;
}

}  // namespace

Measurement measure(const Scene& scene, const ElementMesh& mesh, const MeasureSettings& settings,
                    Progress& progress) {
  const RayScene ray_scene(scene, 1);
  const Engine engine{ray_scene, mesh.elements};
  const RawEmbree robust(scene, true), leaky(scene, false);
  const std::array<RawLoop, 6> loops{{{robust, true, 1, false},
                                      {robust, true, 1, true},
                                      {robust, true, 4, true},
                                      {leaky, false, 1, false},
                                      {leaky, false, 1, true},
                                      {leaky, false, 4, true}}};
  const std::vector<TilePlace> all = upper_triangle(mesh.elements.size());
  const std::vector<TilePlace> traced = sample_tiles(all, settings.most_tiles);
  const std::vector<TilePlace> sample = sample_tiles(traced, settings.sample_tiles);

  Measurement result;
  result.elements = mesh.elements.size();
  result.tiles = all.size();
  result.traced_tiles = traced.size();
  const double scale = static_cast<double>(all.size()) / static_cast<double>(traced.size());
  const double pairs = static_cast<double>(result.elements) * static_cast<double>(result.elements);
  Statistics statistics(result.elements);
  std::vector<double> seconds, raw_rates, leaky_rates, ratios;
  for (int k = 0; k < settings.repetitions; ++k) {
    const Repetition one = repeat(engine, loops, traced, sample, k == 0 ? &statistics : nullptr, progress);
    seconds.push_back(one.engine_seconds * scale);
    raw_rates.push_back(raw_rate(one, loops, true));
    leaky_rates.push_back(raw_rate(one, loops, false));
    ratios.push_back(pairs / seconds.back() / raw_rates.back());
    result.differing = std::max(result.differing, one.differing);
  }
  result.seconds = median(seconds);
  result.raw_rays_per_second = median(raw_rates);
  result.leaky_rays_per_second = median(leaky_rates);
  result.ratio = median(ratios);
  statistics.write(scale, result);
  result.pairs_per_second = pairs / result.seconds;
  result.rays_per_second = result.rays_a_pair * result.pairs_per_second;
  if (settings.classical)
    result.classical_seconds = classical_seconds(scene, mesh, settings.sample_tiles, settings.repetitions);
  return result;
}

}  // namespace fluxel::bench
