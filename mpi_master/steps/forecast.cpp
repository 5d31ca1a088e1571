#include "mpi_master/steps/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/rgb.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/scheduling/row_owners.hpp"
#include "solver/pair_kernel.hpp"

namespace fluxel {

namespace {

// What a node holds once, of its ranks together, and what each rank holds: docs/architecture.md has the list.

/// Vectors of the solve: E, rho and its start twice, nine of conjugate gradients, four of the result and its
/// check, two on the way; areas, row sums, weights and scaling; links between neighbours.
constexpr std::size_t kNodeBytesPerUnknown = 20 * sizeof(Rgb) + 8 * sizeof(double) + 3 * sizeof(float);
/// The x and H by which ranks of one node work together.
constexpr std::size_t kTeamBytesPerUnknown = 2 * sizeof(Rgb);
/// The power sent.
constexpr std::size_t kRankBytesPerUnknown = kChannels * sizeof(float);

constexpr std::size_t kMeshBytes = sizeof(Element) + sizeof(Outline<glm::vec3>);
/// Columns of the row operator.
constexpr std::size_t kColumnBytes = sizeof(TileColumns) / kTileSize + sizeof(float);
/// The tracer's, until the visibility is known.
constexpr std::size_t kPointBytes = sizeof(TilePoints) / kTileSize;
/// The row operator's own areas.
constexpr std::size_t kRankBytesPerElement = sizeof(float);

struct Shares {
  std::uint64_t node = 0;  ///< of the node's ranks together
  std::uint64_t rank = 0;
};

/// What the solve needs beside the visibility and the mesh.
Shares solve_bytes(const Communicator& communicator, std::size_t elements, std::size_t unknowns) {
  const bool team = communicator.node().size() > 1;
  return {elements * kColumnBytes + unknowns * (kNodeBytesPerUnknown + (team ? kTeamBytesPerUnknown : 0)),
          elements * kRankBytesPerElement + unknowns * kRankBytesPerUnknown};
}

std::uint64_t part_of_rank(const Communicator& communicator, std::uint64_t of_node) {
  return of_node / static_cast<std::uint64_t>(communicator.node().size());
}

/// Bytes of the store of a rank that owns these rows.
std::size_t store_bytes(const TileRows& rows, const RowCosts& costs) {
  double bytes = 0;  // of a tile's code, in the mean over the rows
  for (std::size_t row = rows.first; row < rows.last; ++row)
    bytes += costs.bytes[row] / static_cast<double>(rows.size());
  const auto held = static_cast<double>(TileStore::expected_for(costs.bytes.size(), rows));
  return TileStore::bytes_for(costs.bytes.size(), rows, static_cast<std::size_t>(held * bytes));
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
  const Shares solve = solve_bytes(communicator, elements, elements);
  return TileStore::bytes_for(tiles, rows, 0) + solve.rank + elements * kPointBytes +
         part_of_rank(communicator, solve.node + elements * kMeshBytes);
}

Forecast forecast(const Communicator& communicator, const TileTracer& tracer, std::size_t unknowns,
                  int threads, SampleUse use) {
  TileSample sample = sample_tiles(communicator, tracer, threads, use);
  Forecast result;
  result.pairs = tracer.elements() * (tracer.elements() - 1) / 2;
  result.mixed_tiles = static_cast<double>(sample.mixed) / static_cast<double>(sample.tiles);
  result.costs = std::move(sample.costs);
  auto all_threads = static_cast<std::uint64_t>(threads);
  communicator.all_sum(std::span(&all_threads, 1));
  result.visibility_seconds = std::accumulate(result.costs.trace.begin(), result.costs.trace.end(), 0.0) /
                              (static_cast<double>(all_threads) * sample.share_of_processor);

  const RowOwners owners(result.costs.solve, communicator.size());
  std::size_t largest = 0;
  for (int rank = 0; rank < communicator.size(); ++rank) {
    const std::size_t bytes = store_bytes(owners.rows(rank), result.costs);
    result.store_bytes += bytes;
    largest = std::max(largest, bytes);
  }
  const Shares solve = solve_bytes(communicator, tracer.elements(), unknowns);
  // The tracer's points go before the solve begins.
  const std::uint64_t points = tracer.elements() * kPointBytes;
  const std::uint64_t own = largest + solve.rank;
  const std::uint64_t part = own + part_of_rank(communicator, solve.node);
  result.to_come = part - std::min(part, points);
  const std::uint64_t resident = peak_resident_bytes();
  auto bytes = static_cast<double>(resident - std::min(resident, points) + own + solve.node);
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
