#include "mpi_master/scheduling/tile_sample.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numeric>
#include <random>
#include <utility>

#include "core/hash.hpp"
#include "formfactor/sampled_entries.hpp"
#include "visibility/tile_code.hpp"
#include "visibility/tile_range.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

namespace {

constexpr std::uint64_t kTilesPerRound = 1024;
constexpr std::uint64_t kMaxRounds = 4;
constexpr std::uint64_t kTilesPerRow = 16;  // and not fewer rounds
constexpr std::uint64_t kMaxShare = 64;     // of all tiles, where that is more than the rounds
constexpr std::size_t kSmoothing = 64;      // of the matrix, on either side
constexpr double kWantedError = 0.03;       // standard error of a tile's bytes, table included, relative

/// The kernel's time for a tile whose bits must be decoded first and for one without light, where one without
/// bits takes 1.
constexpr double kMixedWork = 1.3, kDarkWork = 0.02;

/// The weight of bytes in the cost of a row, where the kernel's work has 1: whatever the bytes, no rank has
/// much more work than others.
constexpr double kBytesWeight = 0.2;

/// What a tile's corrections may take [s]: where all would take longer some of its lines must do.
constexpr double kExamineSeconds = 5e-5;

/// Sums over the traced tiles of a part of the matrix. Integers, so that they do not depend on the ranks.
struct PartSums {
  std::uint64_t traced = 0, nanoseconds = 0;  // of a part of the tiles by number
  std::uint64_t met = 0, mixed = 0, visible = 0, bytes = 0,
                entries = 0;  // of a part of the rows, which a tile meets twice
};
constexpr std::size_t kPartNumbers = sizeof(PartSums) / sizeof(std::uint64_t);

struct Totals {
  std::uint64_t tiles = 0, mixed = 0, bytes = 0, squared_bytes = 0;
  std::uint64_t busy_nanoseconds = 0;    // of processor time
  std::uint64_t thread_nanoseconds = 0;  // that threads were there for it, running or not

  [[nodiscard]] double mean_bytes() const { return static_cast<double>(bytes) / static_cast<double>(tiles); }
  /// As if the tiles were independent; strata make it smaller.
  [[nodiscard]] double standard_error() const {
    const double mean_square = static_cast<double>(squared_bytes) / static_cast<double>(tiles);
    return std::sqrt(std::max(0.0, mean_square - mean_bytes() * mean_bytes()) / static_cast<double>(tiles));
  }
};
constexpr std::size_t kTotalNumbers = sizeof(Totals) / sizeof(std::uint64_t);

struct Sums {
  explicit Sums(std::size_t count) : parts(count) {}
  explicit Sums(std::vector<PartSums> of_parts) : parts(std::move(of_parts)) {}

  Totals totals;
  std::vector<PartSums> parts;

  /// The part in which the place'th of `all` tiles, or rows, stands.
  [[nodiscard]] PartSums& at(std::uint64_t place, std::uint64_t all) {
    return parts[place * parts.size() / all];
  }
  [[nodiscard]] const PartSums& at(std::uint64_t place, std::uint64_t all) const {
    return parts[place * parts.size() / all];
  }
};

struct TracedPlace {
  std::size_t row = 0, column = 0;
  TileTag tag = TileTag::blocked;
  std::uint64_t bytes = 0, nanoseconds = 0;
  std::uint64_t entries = 0, examine_nanoseconds = 0;  // of corrections
};

/// Processor time of this thread: what others take meanwhile is none of a tile's.
std::uint64_t thread_nanoseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(time.tv_nsec);
}

/// One tile by chance from each of `count` equal parts of all.
std::vector<std::uint64_t> numbers_of_round(std::uint64_t all, std::uint64_t count, std::mt19937_64& random) {
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::uint64_t first = all * k / count, last = all * (k + 1) / count;
    numbers.push_back(first + random() % (last - first));
  }
  return numbers;
}

void trace(const TileTracer& tracer, const TileExaminer* examiner, std::uint64_t number, TracedPlace& place) {
  const std::uint64_t start = thread_nanoseconds();
  const TracedTile tile = tracer.trace(place.row, place.column);
  place.tag = tile.tag;
  if (tile.tag == TileTag::bits) place.bytes = TileStore::pool_bytes(encode_tile(tile.bits).size);
  place.nanoseconds = thread_nanoseconds() - start;
  if (examiner == nullptr) return;
  const std::uint64_t chance = hash_bytes(std::as_bytes(std::span(&number, 1)));
  place.entries = sampled_entries(*examiner, place.row, place.column, tile, kExamineSeconds, chance);
  place.examine_nanoseconds = thread_nanoseconds() - start - place.nanoseconds;
}

void add_to_row(const TracedPlace& tile, PartSums& part) {
  ++part.met;
  if (tile.tag == TileTag::bits) ++part.mixed;
  if (tile.tag == TileTag::visible) ++part.visible;
  part.bytes += tile.bytes;
  part.entries += tile.entries / 2;  // half of them are the other row's
}

/// Every rank traces its own of the numbers.
void trace_round(const Communicator& communicator, const TileTracer& tracer, const TileExaminer* examiner,
                 const TileTriangle& triangle, std::span<const std::uint64_t> numbers, Sums& sums) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  std::vector<TracedPlace> places;
  std::vector<std::uint64_t> own;
  for (std::size_t k = rank; k < numbers.size(); k += ranks) {
    const std::size_t row = triangle.row_of(numbers[k]);
    places.push_back({row, triangle.column_of(row, numbers[k])});
    own.push_back(numbers[k]);
  }
  tbb::parallel_for(std::size_t{0}, places.size(),
                    [&](std::size_t k) { trace(tracer, examiner, own[k], places[k]); });
  for (std::size_t k = 0; k < places.size(); ++k) {
    const TracedPlace& tile = places[k];
    PartSums& part = sums.at(own[k], triangle.size());
    ++part.traced;
    part.nanoseconds += tile.nanoseconds;
    add_to_row(tile, sums.at(tile.row, triangle.side()));
    add_to_row(tile, sums.at(tile.column, triangle.side()));
    if (tile.tag == TileTag::bits) ++sums.totals.mixed;
    sums.totals.bytes += tile.bytes;
    sums.totals.busy_nanoseconds += tile.nanoseconds + tile.examine_nanoseconds;
    sums.totals.squared_bytes += tile.bytes * tile.bytes;
  }
  sums.totals.tiles += places.size();
}

Sums over_all_ranks(const Communicator& communicator, const Sums& own) {
  using PartNumbers = std::array<std::uint64_t, kPartNumbers>;
  using TotalNumbers = std::array<std::uint64_t, kTotalNumbers>;
  std::vector<std::uint64_t> flat;
  const auto append = [&](const auto& numbers) { flat.insert(flat.end(), numbers.begin(), numbers.end()); };
  append(std::bit_cast<TotalNumbers>(own.totals));
  for (const PartSums& part : own.parts) append(std::bit_cast<PartNumbers>(part));
  communicator.all_sum(flat);

  Sums all(own.parts.size());
  auto next = flat.begin();
  const auto take = [&](auto numbers) {
    std::copy_n(next, numbers.size(), numbers.begin());
    next += static_cast<std::ptrdiff_t>(numbers.size());
    return numbers;
  };
  all.totals = std::bit_cast<Totals>(take(TotalNumbers{}));
  for (PartSums& part : all.parts) part = std::bit_cast<PartSums>(take(PartNumbers{}));
  return all;
}

double traced_seconds(const Sums& sums) {
  std::uint64_t nanoseconds = 0;
  for (const PartSums& part : sums.parts) nanoseconds += part.nanoseconds;
  return 1e-9 * static_cast<double>(nanoseconds);
}

/// The tiles that were traced within kSmoothing of the matrix on either side of each part: a few tiles of one
/// part would say little, since tiles differ by a hundred times.
std::vector<PartSums> smoothed(const std::vector<PartSums>& parts) {
  const std::size_t reach = parts.size() / kSmoothing;
  std::vector<PartSums> wide(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::size_t first = k - std::min(k, reach), last = std::min(parts.size(), k + reach + 1);
    for (std::size_t other = first; other < last; ++other) {
      wide[k].traced += parts[other].traced;
      wide[k].nanoseconds += parts[other].nanoseconds;
    }
  }
  return wide;
}

std::vector<double> trace_costs(const TileTriangle& triangle, const Sums& sums) {
  const double mean = traced_seconds(sums) / static_cast<double>(sums.totals.tiles);
  const Sums wide{smoothed(sums.parts)};
  std::vector<double> costs;
  for (std::size_t row = 0; row < triangle.side(); ++row) {
    const std::uint64_t tiles = triangle.side() - row;
    const PartSums& part = wide.at(triangle.first_of(row) + tiles / 2, triangle.size());
    const double of_part = 1e-9 * static_cast<double>(part.nanoseconds) / static_cast<double>(part.traced);
    costs.push_back(static_cast<double>(tiles) * (part.traced > 0 ? of_part : mean));
  }
  return costs;
}

/// What a tile of each row has of it in the mean, either way round.
std::vector<double> row_means(const TileTriangle& triangle, const Sums& sums, std::uint64_t PartSums::*what) {
  std::uint64_t of_all = 0, met = 0;
  for (const PartSums& part : sums.parts) {
    of_all += part.*what;
    met += part.met;
  }
  std::vector<double> means;
  for (std::size_t row = 0; row < triangle.side(); ++row) {
    const PartSums& part = sums.at(row, triangle.side());
    means.push_back(part.met > 0 ? static_cast<double>(part.*what) / static_cast<double>(part.met)
                                 : static_cast<double>(of_all) / static_cast<double>(met));
  }
  return means;
}

std::vector<double> solve_costs(const TileTriangle& triangle, const Sums& sums,
                                std::span<const double> bytes) {
  std::vector<double> work;
  for (std::size_t row = 0; row < triangle.side(); ++row) {
    const PartSums& part = sums.at(row, triangle.side());
    const auto met = static_cast<double>(part.met), mixed = static_cast<double>(part.mixed);
    const double share = part.met > 0 ? 1 / met : 0;
    work.push_back(row_work(share * mixed, share * static_cast<double>(part.visible)));
  }
  const double all_work = std::accumulate(work.begin(), work.end(), 0.0);
  constexpr double kTableEntry = sizeof(std::uint32_t);
  const double all_bytes =
      std::accumulate(bytes.begin(), bytes.end(), kTableEntry * static_cast<double>(triangle.side()));
  std::vector<double> costs;
  for (std::size_t row = 0; row < triangle.side(); ++row)
    costs.push_back(work[row] / all_work + kBytesWeight * (bytes[row] + kTableEntry) / all_bytes);
  return costs;
}

}  // namespace

double row_work(double mixed, double visible) { return kDarkWork + visible + kMixedWork * mixed; }

RowCosts RowCosts::even(std::size_t tile_rows, double seconds) {
  RowCosts costs{{},
                 std::vector<double>(tile_rows, 1.0),
                 std::vector<double>(tile_rows, 0.0),
                 std::vector<double>(tile_rows, 0.0)};
  for (std::size_t row = 0; row < tile_rows; ++row)
    costs.trace.push_back(seconds * static_cast<double>(tile_rows - row));
  return costs;
}

TileSample sample_tiles(const Communicator& communicator, const TileTracer& tracer, int threads,
                        SampleUse use, const TileExaminer* examiner) {
  const TileTriangle triangle(tile_count(tracer.elements()));
  const std::uint64_t few = kMaxRounds * kTilesPerRound;
  const std::uint64_t most = std::min(triangle.size(), std::max(few, triangle.size() / kMaxShare));
  const bool totals = use == SampleUse::totals;
  const std::uint64_t least = std::min(most, totals ? few : kTilesPerRow * triangle.side());
  const std::uint64_t round = std::min(triangle.size(), std::max(kTilesPerRound, least / kMaxRounds));
  const std::uint64_t parts = (totals ? least : most) / kTilesPerRow;
  Sums own(std::clamp<std::uint64_t>(parts, 1, triangle.side())), all(0);
  std::mt19937_64 random(1);
  tbb::task_arena arena(threads);
  do {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    const std::vector<std::uint64_t> numbers = numbers_of_round(triangle.size(), round, random);
    arena.execute([&] { trace_round(communicator, tracer, examiner, triangle, numbers, own); });
    own.totals.thread_nanoseconds +=
        static_cast<std::uint64_t>(threads) *
        static_cast<std::uint64_t>(std::chrono::nanoseconds(Clock::now() - start).count());
    all = over_all_ranks(communicator, own);
    // An entry of the table is known.
  } while (all.totals.tiles + round <= most &&
           (all.totals.tiles < least ||
            all.totals.standard_error() > kWantedError * (sizeof(std::uint32_t) + all.totals.mean_bytes())));

  TileSample sample{all.totals.tiles, all.totals.mixed, {}, 0};
  const std::vector<double> bytes = row_means(triangle, all, &PartSums::bytes);
  sample.costs = {trace_costs(triangle, all), solve_costs(triangle, all, bytes), bytes,
                  row_means(triangle, all, &PartSums::entries)};
  sample.share_of_processor = std::min(1.0, static_cast<double>(all.totals.busy_nanoseconds) /
                                                static_cast<double>(all.totals.thread_nanoseconds));
  return sample;
}

}  // namespace fluxel
