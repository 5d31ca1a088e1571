#include "mpi_master/forecast.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <random>

#include "core/rgb.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/machine.hpp"
#include "mpi_master/strip_scheduler.hpp"
#include "solver/pair_kernel.hpp"
#include "visibility/tile_code.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kTilesPerRound = 1024;
constexpr std::size_t kMostRounds = 4;
constexpr std::size_t kMostShare = 64;  // of all tiles, where that is more
constexpr double kWantedError = 0.03;   // standard error of a tile's bytes, table included, relative

/// Vectors of the solve: E, rho and its start twice, nine of conjugate gradients, four of the result and its
/// check, two on the way; areas, row sums, weights and scaling; links between neighbours; the power sent.
constexpr std::size_t kBytesPerUnknown =
    20 * sizeof(Rgb) + 8 * sizeof(double) + 3 * sizeof(float) + kChannels * sizeof(float);
/// Of the row operator.
constexpr std::size_t kColumnBytes = sizeof(TileColumns) / kTileSize + 2 * sizeof(float);
constexpr std::size_t kBytesPerElement =
    sizeof(Element) + sizeof(Outline<glm::vec3>) + sizeof(TilePoints) / kTileSize + kColumnBytes;

/// Sums over traced tiles. One whose row and column have two owners is held twice; few of those near the
/// diagonal are, and few of these have bits.
struct Sample {
  std::size_t tiles = 0;
  std::size_t mixed = 0;
  std::uint64_t held = 0;
  std::uint64_t code_bytes = 0;     // of tiles held
  std::uint64_t squared_bytes = 0;  // of tiles held
  double seconds = 0;

  [[nodiscard]] double mean_bytes() const {
    return static_cast<double>(code_bytes) / static_cast<double>(held);
  }
  /// As if the tiles were independent; strata make it smaller.
  [[nodiscard]] double standard_error() const {
    const double mean_square = static_cast<double>(squared_bytes) / static_cast<double>(held);
    return std::sqrt((mean_square - mean_bytes() * mean_bytes()) / static_cast<double>(tiles));
  }
};

struct TilePlace {
  std::size_t row, column;
};

/// All tiles on and above the diagonal where a round holds them, else one by chance from each of as many
/// equal parts of them, row after row.
std::vector<TilePlace> places_of_round(std::size_t tiles, std::mt19937_64& random) {
  const std::size_t all = tiles * (tiles + 1) / 2;
  const std::size_t count = std::min(all, kTilesPerRound);
  std::vector<TilePlace> places;
  std::size_t row = 0, row_start = 0;  // number of the row's first tile
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = all * k / count, last = all * (k + 1) / count;
    const std::size_t number = first + random() % (last - first);
    for (; number - row_start >= tiles - row; ++row) row_start += tiles - row;
    places.push_back({row, row + (number - row_start)});
  }
  return places;
}

void trace_round(const TileTracer& tracer, std::span<const TilePlace> places, std::size_t tiles, int ranks,
                 Sample& sample) {
  std::atomic<std::uint64_t> mixed = 0, held = 0, code_bytes = 0, squared_bytes = 0;
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t k) {
    const auto [row, column] = places[k];
    const std::uint64_t copies = owner_of(tiles, ranks, row) == owner_of(tiles, ranks, column) ? 1 : 2;
    held += copies;
    const TracedTile tile = tracer.trace(row, column);
    if (tile.tag != TileTag::bits) return;
    const std::uint64_t bytes = TileStore::pool_bytes(encode_tile(tile.bits).size);
    ++mixed;
    code_bytes += copies * bytes;
    squared_bytes += copies * bytes * bytes;
  });
  sample.tiles += places.size();
  sample.mixed += mixed;
  sample.held += held;
  sample.code_bytes += code_bytes;
  sample.squared_bytes += squared_bytes;
}

Sample trace_sample(const TileTracer& tracer, std::size_t tiles, int ranks, int threads) {
  const std::size_t all = tiles * (tiles + 1) / 2;
  const std::size_t most = std::min(all, std::max(kMostRounds * kTilesPerRound, all / kMostShare));
  Sample sample;
  std::mt19937_64 random(1);
  const auto start = std::chrono::steady_clock::now();
  tbb::task_arena arena(threads);
  arena.execute([&] {
    do {
      trace_round(tracer, places_of_round(tiles, random), tiles, ranks, sample);
      // An entry of the table is known.
    } while (sample.tiles + kTilesPerRound <= most &&
             sample.standard_error() > kWantedError * (sizeof(std::uint32_t) + sample.mean_bytes()));
  });
  sample.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return sample;
}

/// Bytes of the store of a rank that owns these rows.
std::size_t store_bytes(std::size_t tiles, const TileRows& rows, const Sample& sample) {
  const auto held = static_cast<double>(TileStore::expected_for(tiles, rows));
  return TileStore::bytes_for(tiles, rows, static_cast<std::size_t>(held * sample.mean_bytes()));
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

Forecast forecast(const Communicator& communicator, const TileTracer& tracer, std::size_t unknowns,
                  int threads) {
  const std::size_t tiles = tile_count(tracer.elements());
  const Sample sample = trace_sample(tracer, tiles, communicator.size(), threads);
  Forecast result;
  result.pairs = tracer.elements() * (tracer.elements() - 1) / 2;
  result.mixed_tiles = static_cast<double>(sample.mixed) / static_cast<double>(sample.tiles);
  // Ranks of different speed share the work: their rates add up.
  const double rate = static_cast<double>(sample.tiles) / sample.seconds;
  const std::vector<double> rates = communicator.all_gather(std::span(&rate, 1));
  double all_rates = 0;
  for (const double of_rank : rates) all_rates += of_rank;
  result.visibility_seconds = 0.5 * static_cast<double>(tiles * (tiles + 1)) / all_rates;

  for (int rank = 0; rank < communicator.size(); ++rank)
    result.store_bytes += store_bytes(tiles, owned_rows(tiles, communicator.size(), rank), sample);
  const std::size_t rows = std::min(tiles, most_rows(communicator, tiles));
  const std::uint64_t peak = peak_resident_bytes() + store_bytes(tiles, {0, rows}, sample) +
                             tracer.elements() * kColumnBytes + unknowns * kBytesPerUnknown;
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
