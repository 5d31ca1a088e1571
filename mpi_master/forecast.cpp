#include "mpi_master/forecast.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>

#include "core/rgb.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/machine.hpp"
#include "mpi_master/strip_scheduler.hpp"
#include "visibility/trace_tile.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kMostSampleTiles = 1024;

/// Vectors of the solve: E, rho, B, H, the next B and gathered copies of two, and bounds with a few numbers.
constexpr std::size_t kBytesPerUnknown = 7 * sizeof(Rgb) + 6 * sizeof(double) + kChannels * sizeof(float);
constexpr std::size_t kBytesPerElement = sizeof(Element) + sizeof(Outline<glm::vec3>) + 7 * sizeof(float);

struct Sample {
  std::size_t tiles = 0;
  std::size_t mixed = 0;
  double seconds = 0;
};

/// All tiles on and above the diagonal where they are few, else as many of them by chance.
std::vector<std::pair<std::size_t, std::size_t>> sample_places(std::size_t tiles) {
  std::vector<std::pair<std::size_t, std::size_t>> places;
  if (tiles * (tiles + 1) / 2 <= kMostSampleTiles) {
    for (std::size_t row = 0; row < tiles; ++row)
      for (std::size_t column = row; column < tiles; ++column) places.emplace_back(row, column);
    return places;
  }
  std::mt19937_64 random(1);
  while (places.size() < kMostSampleTiles) {
    const std::size_t a = random() % tiles, b = random() % tiles;
    places.emplace_back(std::min(a, b), std::max(a, b));
  }
  return places;
}

Sample trace_sample(const RayScene& ray_scene, std::span<const Element> elements, std::size_t tiles,
                    int threads) {
  const auto places = sample_places(tiles);
  std::atomic<std::size_t> mixed = 0;
  const auto start = std::chrono::steady_clock::now();
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t k) {
      if (trace_tile(ray_scene, elements, places[k].first, places[k].second).tag == TileTag::bits) ++mixed;
    });
  });
  return {places.size(), mixed,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

std::size_t most_rows(const Communicator& communicator, std::size_t tiles) {
  return tiles / static_cast<std::size_t>(communicator.size()) + 1;
}

std::string in_gib(std::uint64_t bytes) {
  return fmt::format("{:.3g} GiB", static_cast<double>(bytes) * 0x1p-30);
}

}  // namespace

std::uint64_t least_bytes(const Communicator& communicator, std::size_t elements) {
  const std::size_t tiles = tile_count(elements);
  const TileRows rows{0, std::min(tiles, most_rows(communicator, tiles))};
  return TileStore::bytes_for(tiles, rows, 0) + elements * (kBytesPerElement + kBytesPerUnknown);
}

Forecast forecast(const Communicator& communicator, const RayScene& ray_scene,
                  std::span<const Element> elements, std::size_t unknowns, int threads) {
  const std::size_t tiles = tile_count(elements.size());
  const Sample sample = trace_sample(ray_scene, elements, tiles, threads);
  Forecast result;
  result.pairs = elements.size() * (elements.size() - 1) / 2;
  result.mixed_tiles = static_cast<double>(sample.mixed) / static_cast<double>(sample.tiles);
  // Ranks of different speed share the work: their rates add up.
  const double rate = static_cast<double>(sample.tiles) / sample.seconds;
  const std::vector<double> rates = communicator.all_gather(std::span(&rate, 1));
  double all_rates = 0;
  for (const double of_rank : rates) all_rates += of_rank;
  result.visibility_seconds = 0.5 * static_cast<double>(tiles * (tiles + 1)) / all_rates;

  const std::size_t rows = std::min(tiles, most_rows(communicator, tiles));
  // Tiles that meet owned rows, each once: all columns but for those counted twice.
  const double held = static_cast<double>(rows) * static_cast<double>(tiles) -
                      static_cast<double>(rows * (rows - std::min<std::size_t>(rows, 1))) / 2;
  const auto mixed = static_cast<std::size_t>(held * result.mixed_tiles);
  const std::uint64_t peak = peak_resident_bytes() + TileStore::bytes_for(tiles, {0, rows}, mixed) +
                             elements.size() * 7 * sizeof(float) + unknowns * kBytesPerUnknown;
  auto bytes = static_cast<double>(peak);
  communicator.all_max(std::span(&bytes, 1));
  result.bytes = static_cast<std::uint64_t>(bytes);
  return result;
}

void require_memory(const Communicator& communicator, std::uint64_t bytes, const std::string& what) {
  const std::vector<RankPlace> places = rank_places(communicator, 1);
  const RankPlace& mine = places[static_cast<std::size_t>(communicator.rank())];
  agree(communicator, [&] {
    const std::uint64_t available = available_bytes(mine.ranks_on_host);
    if (bytes > available)
      throw InputError(
          fmt::format("not enough memory: {} needs {} on rank {}, and {} has {} for it (use more "
                      "hosts, a smaller --resolution, or a larger --max-edge)",
                      what, in_gib(bytes), communicator.rank(), mine.host, in_gib(available)));
  });
}

}  // namespace fluxel
