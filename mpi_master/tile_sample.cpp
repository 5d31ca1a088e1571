#include "mpi_master/tile_sample.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

#include "visibility/tile_code.hpp"
#include "visibility/tile_range.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

namespace {

constexpr std::uint64_t kTilesPerRound = 1024;
constexpr std::uint64_t kMostRounds = 4;
constexpr std::uint64_t kMostShare = 64;  // of all tiles, where that is more
constexpr double kWantedError = 0.03;     // standard error of a tile's bytes, table included, relative

/// Parts of the matrix whose costs are told apart: of equal numbers of tiles for tracing, of rows for
/// solving.
constexpr std::uint64_t kParts = 64;

/// The kernel's time for a tile whose bits must be decoded first and for one without light, where one without
/// bits takes 1.
constexpr double kMixedWork = 1.3, kDarkWork = 0.02;

/// Sums over the traced tiles of one part: integers, so that they do not depend on the ranks.
struct PartSums {
  std::uint64_t traced = 0;                         // tiles of this part by number
  std::uint64_t nanoseconds = 0;                    // of these
  std::uint64_t met = 0;                            // rows and columns of tiles in this part by row
  std::uint64_t mixed = 0, visible = 0, bytes = 0;  // of these
};

struct Sums {
  std::vector<PartSums> parts = std::vector<PartSums>(kParts);
  std::uint64_t tiles = 0, mixed = 0, bytes = 0, squared_bytes = 0;

  [[nodiscard]] double mean_bytes() const { return static_cast<double>(bytes) / static_cast<double>(tiles); }
  /// As if the tiles were independent; strata make it smaller.
  [[nodiscard]] double standard_error() const {
    const double mean_square = static_cast<double>(squared_bytes) / static_cast<double>(tiles);
    return std::sqrt(std::max(0.0, mean_square - mean_bytes() * mean_bytes()) / static_cast<double>(tiles));
  }
};

/// What one traced tile adds.
struct Traced {
  TileTag tag = TileTag::blocked;
  std::uint64_t bytes = 0, nanoseconds = 0;
};

/// All tiles where a round holds them, else one by chance from each of as many equal parts of them.
std::vector<std::uint64_t> numbers_of_round(std::uint64_t all, std::mt19937_64& random) {
  const std::uint64_t count = std::min(all, kTilesPerRound);
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::uint64_t first = all * k / count, last = all * (k + 1) / count;
    numbers.push_back(first + random() % (last - first));
  }
  return numbers;
}

Traced trace(const TileTracer& tracer, std::size_t row, std::size_t column) {
  const auto start = std::chrono::steady_clock::now();
  const TracedTile tile = tracer.trace(row, column);
  Traced traced{tile.tag};
  if (tile.tag == TileTag::bits) traced.bytes = TileStore::pool_bytes(encode_tile(tile.bits).size);
  traced.nanoseconds = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start).count());
  return traced;
}

void add_row(PartSums& part, const Traced& tile) {
  ++part.met;
  if (tile.tag == TileTag::bits) ++part.mixed;
  if (tile.tag == TileTag::visible) ++part.visible;
  part.bytes += tile.bytes;
}

/// Every rank traces its own of the numbers.
void trace_round(const Communicator& communicator, const TileTracer& tracer, const TileTriangle& triangle,
                 std::span<const std::uint64_t> numbers, Sums& sums) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  if (rank >= numbers.size()) return;
  std::vector<Traced> traced((numbers.size() - rank - 1) / ranks + 1);
  const auto place = [&](std::size_t k) { return numbers[rank + k * ranks]; };
  tbb::parallel_for(std::size_t{0}, traced.size(), [&](std::size_t k) {
    const std::size_t row = triangle.row_of(place(k));
    traced[k] = trace(tracer, row, triangle.column_of(row, place(k)));
  });
  for (std::size_t k = 0; k < traced.size(); ++k) {
    const Traced& tile = traced[k];
    PartSums& part = sums.parts[place(k) * kParts / triangle.size()];
    ++part.traced;
    part.nanoseconds += tile.nanoseconds;
    const std::size_t row = triangle.row_of(place(k)), column = triangle.column_of(row, place(k));
    add_row(sums.parts[row * kParts / triangle.side()], tile);
    add_row(sums.parts[column * kParts / triangle.side()], tile);
    if (tile.tag == TileTag::bits) ++sums.mixed;
    sums.bytes += tile.bytes;
    sums.squared_bytes += tile.bytes * tile.bytes;
  }
  sums.tiles += traced.size();
}

Sums over_all_ranks(const Communicator& communicator, const Sums& own) {
  std::vector<std::uint64_t> flat{own.tiles, own.mixed, own.bytes, own.squared_bytes};
  for (const PartSums& part : own.parts)
    flat.insert(flat.end(), {part.traced, part.nanoseconds, part.met, part.mixed, part.visible, part.bytes});
  communicator.all_sum(flat);
  Sums all;
  all.tiles = flat[0], all.mixed = flat[1], all.bytes = flat[2], all.squared_bytes = flat[3];
  const std::uint64_t* at = flat.data() + 4;
  for (PartSums& part : all.parts) {
    part = {at[0], at[1], at[2], at[3], at[4], at[5]};
    at += 6;
  }
  return all;
}

std::vector<double> trace_costs(const TileTriangle& triangle, const Sums& sums) {
  double seconds = 0;
  for (const PartSums& part : sums.parts) seconds += 1e-9 * static_cast<double>(part.nanoseconds);
  const double mean = seconds / static_cast<double>(sums.tiles);
  std::vector<double> costs;
  for (std::size_t row = 0; row < triangle.side(); ++row) {
    const std::uint64_t tiles = triangle.side() - row;
    const PartSums& part = sums.parts[(triangle.first_of(row) + tiles / 2) * kParts / triangle.size()];
    const double of_part = 1e-9 * static_cast<double>(part.nanoseconds) / static_cast<double>(part.traced);
    costs.push_back(static_cast<double>(tiles) * (part.traced > 0 ? of_part : mean));
  }
  return costs;
}

std::vector<double> row_bytes(const TileTriangle& triangle, const Sums& sums) {
  std::vector<double> bytes;
  for (std::size_t row = 0; row < triangle.side(); ++row) {
    const PartSums& part = sums.parts[row * kParts / triangle.side()];
    bytes.push_back(part.met > 0 ? static_cast<double>(part.bytes) / static_cast<double>(part.met)
                                 : sums.mean_bytes());
  }
  return bytes;
}

std::vector<double> solve_costs(const TileTriangle& triangle, const Sums& sums, std::vector<double> bytes) {
  std::vector<double> work;
  for (std::size_t row = 0; row < triangle.side(); ++row) {
    const PartSums& part = sums.parts[row * kParts / triangle.side()];
    const auto met = static_cast<double>(part.met), mixed = static_cast<double>(part.mixed);
    const double lit = kMixedWork * mixed + static_cast<double>(part.visible);
    work.push_back(kDarkWork + (part.met > 0 ? lit / met : 0));
    bytes[row] += sizeof(std::uint32_t);
  }
  const double all_work = std::accumulate(work.begin(), work.end(), 0.0);
  const double all_bytes = std::accumulate(bytes.begin(), bytes.end(), 0.0);
  std::vector<double> costs;
  for (std::size_t row = 0; row < triangle.side(); ++row)
    costs.push_back(0.5 * (work[row] / all_work + bytes[row] / all_bytes));
  return costs;
}

}  // namespace

RowCosts RowCosts::even(std::size_t tile_rows, double seconds) {
  RowCosts costs{{}, std::vector<double>(tile_rows, 1.0), std::vector<double>(tile_rows, 0.0)};
  for (std::size_t row = 0; row < tile_rows; ++row)
    costs.trace.push_back(seconds * static_cast<double>(tile_rows - row));
  return costs;
}

TileSample sample_tiles(const Communicator& communicator, const TileTracer& tracer, int threads) {
  const TileTriangle triangle(tile_count(tracer.elements()));
  const std::uint64_t most =
      std::min(triangle.size(), std::max(kMostRounds * kTilesPerRound, triangle.size() / kMostShare));
  Sums own, all;
  std::mt19937_64 random(1);
  tbb::task_arena arena(threads);
  do {
    const std::vector<std::uint64_t> numbers = numbers_of_round(triangle.size(), random);
    arena.execute([&] { trace_round(communicator, tracer, triangle, numbers, own); });
    all = over_all_ranks(communicator, own);
    // An entry of the table is known.
  } while (all.tiles + kTilesPerRound <= most &&
           all.standard_error() > kWantedError * (sizeof(std::uint32_t) + all.mean_bytes()));

  std::vector<double> bytes = row_bytes(triangle, all);
  return {all.tiles, all.mixed, {trace_costs(triangle, all), solve_costs(triangle, all, bytes), bytes}};
}

}  // namespace fluxel
