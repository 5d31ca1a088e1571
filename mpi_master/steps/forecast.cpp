#include "mpi_master/steps/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/rgb.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/scheduling/row_owners.hpp"
#include "solver/estimate_power.hpp"
#include "solver/pair_kernel.hpp"

namespace fluxel {

namespace {

// What a host holds once, of its ranks together, and what each rank holds: docs/architecture.md has the list.

/// Vectors of the solve, of a rank's own rows: E, rho and its start twice, nine of conjugate gradients, four
/// of the result and its check, two on the way; areas, row sums, weights and scaling; links between
/// neighbours.
constexpr std::size_t kOwnBytesPerUnknown = 20 * sizeof(Rgb) + 8 * sizeof(double) + 3 * sizeof(float);
/// The power of the columns in a product; of the leader when the solve has ended: E, rho, B and H, one on the
/// way, areas and row sums.
constexpr std::size_t kHostBytesPerUnknown = kChannels * sizeof(float) + 5 * sizeof(Rgb) + 2 * sizeof(double);

constexpr std::size_t kMeshBytes = sizeof(Element) + sizeof(Outline<glm::vec3>);
/// Columns of the row operator.
constexpr std::size_t kColumnBytes = sizeof(TileColumns) / kTileSize + sizeof(float);
/// The tracer's, until the visibility is known.
constexpr std::size_t kPointBytes = sizeof(TilePoints) / kTileSize;
/// What a pair is worth, and where the corrections of a row begin.
constexpr std::size_t kPowerBytes = 2 * sizeof(double), kRowStartBytes = sizeof(std::uint64_t);
/// By which near pairs are told quickly.
constexpr std::size_t kFilterBytes = 8 * sizeof(float);
/// The row operator's own areas.
constexpr std::size_t kRankBytesPerElement = sizeof(float);

/// What is asked for over what is likely: evenly spread light makes some too few corrections.
constexpr double kCorrectionsMargin = 1.3;

struct Shares {
  std::uint64_t host = 0;  ///< of the host's ranks together
  std::uint64_t rank = 0;
};

/// What the solve needs beside the visibility, the mesh, the vectors of own rows and the corrections
/// themselves.
Shares solve_bytes(std::size_t elements, std::size_t unknowns, bool corrected) {
  return {elements * kColumnBytes + unknowns * kHostBytesPerUnknown,
          elements * kRankBytesPerElement + (corrected ? unknowns * kRowStartBytes : 0)};
}

/// Vectors of the solve, of these of all tile rows.
std::size_t own_bytes(const TileRows& rows, std::size_t tiles, std::size_t unknowns) {
  return unknowns * kOwnBytesPerUnknown * rows.size() / std::max<std::size_t>(tiles, 1);
}

/// The same of the search for corrections, which ends before the solve begins.
Shares search_bytes(std::size_t elements, std::size_t unknowns) {
  return {elements * kColumnBytes, elements * kFilterBytes + unknowns * (kPowerBytes + kRowStartBytes)};
}

std::uint64_t part_of_rank(const Communicator& communicator, std::uint64_t of_host) {
  return of_host / static_cast<std::uint64_t>(communicator.host().size());
}

/// Bytes of the store of a rank that owns these rows.
std::size_t store_bytes(const TileRows& rows, const RowCosts& costs) {
  double bytes = 0;  // of a tile's code, in the mean over the rows
  for (std::size_t row = rows.first; row < rows.last; ++row)
    bytes += costs.bytes[row] / static_cast<double>(rows.size());
  const auto held = static_cast<double>(TileStore::expected_for(costs.bytes.size(), rows));
  return TileStore::bytes_for(costs.bytes.size(), rows, static_cast<std::size_t>(held * bytes));
}

/// Entries of corrections in these rows.
double correction_entries(const TileRows& rows, const RowCosts& costs) {
  const auto first = costs.corrections.begin();
  const double of_tiles = std::accumulate(first + static_cast<std::ptrdiff_t>(rows.first),
                                          first + static_cast<std::ptrdiff_t>(rows.last), 0.0);
  return of_tiles * static_cast<double>(costs.corrections.size());
}

TileSample sample_corrections(const Communicator& communicator, const TileTracer& tracer, int threads,
                              SampleUse use, const PairsToCorrect& pairs) {
  const PowerEstimate power = even_power(make_unknowns(pairs.mesh.elements, pairs.scene.materials));
  const TileExaminer examiner(pairs.ray_scene, pairs.scene, pairs.mesh, pairs.options, power);
  return sample_tiles(communicator, tracer, threads, use, &examiner);
}

std::string in_gib(std::uint64_t bytes) {
  return fmt::format("{:.3g} GiB", static_cast<double>(bytes) * 0x1p-30);
}

}  // namespace

std::uint64_t least_bytes(const Communicator& communicator, std::size_t elements) {
  const std::size_t tiles = tile_count(elements);
  // The rank that has most has at least an even share.
  const std::size_t even = tiles / static_cast<std::size_t>(communicator.size()) + 1;
  const TileRows rows{0, std::min(tiles, even)};
  const Shares solve = solve_bytes(elements, elements, false);
  return TileStore::bytes_for(tiles, rows, 0) + own_bytes(rows, tiles, elements) + solve.rank +
         elements * kPointBytes + part_of_rank(communicator, solve.host + elements * kMeshBytes);
}

Forecast forecast(const Communicator& communicator, const TileTracer& tracer, std::size_t unknowns,
                  int threads, SampleUse use, const std::optional<PairsToCorrect>& pairs) {
  const bool corrected = pairs && has_corrections(pairs->options);
  TileSample sample = corrected ? sample_corrections(communicator, tracer, threads, use, *pairs)
                                : sample_tiles(communicator, tracer, threads, use);
  Forecast result;
  result.pairs = tracer.elements() * (tracer.elements() - 1) / 2;
  result.mixed_tiles = static_cast<double>(sample.mixed) / static_cast<double>(sample.tiles);
  result.costs = std::move(sample.costs);
  auto all_threads = static_cast<std::uint64_t>(threads);
  communicator.all_sum(std::span(&all_threads, 1));
  result.visibility_seconds = std::accumulate(result.costs.trace.begin(), result.costs.trace.end(), 0.0) /
                              (static_cast<double>(all_threads) * sample.share_of_processor);

  const Shares search = search_bytes(tracer.elements(), corrected ? unknowns : 0);
  const Shares solve = solve_bytes(tracer.elements(), unknowns, corrected);
  const RowOwners owners(result.costs.solve, communicator.size());
  std::uint64_t searching = 0, solving = 0;  // of the rank that needs most
  for (int rank = 0; rank < communicator.size(); ++rank) {
    const std::size_t store = store_bytes(owners.rows(rank), result.costs);
    const double likely = correction_entries(owners.rows(rank), result.costs);
    const auto entries = static_cast<std::uint64_t>(kCorrectionsMargin * likely);
    result.store_bytes += store;
    result.correction_bytes += static_cast<std::uint64_t>(likely) * kCorrectionBytes;
    searching = std::max(searching, store + search.rank + entries * kFoundCorrectionBytes);
    const std::size_t own = own_bytes(owners.rows(rank), result.costs.bytes.size(), unknowns);
    solving = std::max(solving, store + own + solve.rank + entries * kCorrectionBytes);
  }
  if (!corrected) searching = 0;
  // The tracer's points go before the search and the solve begin.
  const std::uint64_t points = tracer.elements() * kPointBytes;
  const std::uint64_t part = std::max(searching + part_of_rank(communicator, search.host),
                                      solving + part_of_rank(communicator, solve.host));
  result.to_come = part - std::min(part, points);
  const std::uint64_t resident = peak_resident_bytes();
  auto bytes = static_cast<double>(resident - std::min(resident, points) +
                                   std::max(searching + search.host, solving + solve.host));
  communicator.all_max(std::span(&bytes, 1));
  result.bytes = static_cast<std::uint64_t>(bytes);
  return result;
}

void require_memory(const Communicator& communicator, std::uint64_t bytes, const std::string& what,
                    std::string_view remedy) {
  const std::vector<RankPlace> places = rank_places(communicator, 1);
  const RankPlace& mine = places[static_cast<std::size_t>(communicator.rank())];
  agree(communicator, [&] {
    const std::uint64_t available = available_bytes(mine.ranks_on_host);
    if (bytes > available)
      throw InputError(fmt::format("not enough memory: {} needs {} on rank {}, and {} has {} for it ({})",
                                   what, in_gib(bytes), communicator.rank(), mine.host, in_gib(available),
                                   remedy));
  });
}

}  // namespace fluxel
