#include "bench/simulate/solve_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/rgb.hpp"
#include "mpi_master/scheduling/tile_sample.hpp"
#include "solver/column_power.hpp"
#include "solver/exact_sum.hpp"

namespace fluxel::bench {

namespace {

// An iteration of solver/conjugate_gradients and what judges it, one product of RowOperator.
constexpr double kSums = 6;    // two dot products, mean, variation over elements, two norms of errors
constexpr double kMaxima = 5;  // unit of power, largest change, two bounds of errors, signals

// As in mpi_master/communication/communicator.cpp.
constexpr double kAwake = 200e-6, kShortSleep = 50e-6;

/// Of a tree over so many ranks, up and down, as MPI_Iallreduce of coll/libnbc and barriers have it.
double steps(double ranks) { return 2 * std::ceil(std::log2(ranks)); }

/// By how much each step is later because a rank on the way sleeps that has waited so long.
double late(double waited, const JobSettings& settings) {
  return waited > kAwake ? (kShortSleep + settings.timer_slack) / 2 : 0;
}

/// Hosts meet, leaders gather, hosts meet again. Open MPI 4 sends from everyone to everyone (MPI_Iallgatherv
/// of coll/libnbc).
double exchange_seconds(std::size_t elements, const JobSettings& settings) {
  const auto ranks = static_cast<double>(settings.speed.size());
  if (ranks < 2) return 0;
  const Network& network = settings.network;
  const double on_host = std::min(ranks, static_cast<double>(network.ranks_per_host));
  const double hosts = std::ceil(ranks / on_host);
  const double bytes = static_cast<double>(2 * elements * kChannels * sizeof(float));
  const double messages =
      3 * (hosts - 1) * (settings.costs.send + settings.costs.receive + network.message_gap);
  const double gather = hosts < 2 ? 0
                                  : bytes * (hosts - 1) / hosts / network.between_hosts.bytes_per_second +
                                        messages + network.between_hosts.latency;
  const double meeting = steps(on_host) * network.within_host.latency;
  return meeting + gather + meeting + steps(on_host) * late(gather, settings);
}

/// Of all ranks; in the first one after the product those who had less to do have waited for `waited`.
double sums_seconds(double waited, const JobSettings& settings) {
  const auto ranks = static_cast<double>(settings.speed.size());
  if (ranks < 2) return 0;
  const Network& network = settings.network;
  const Channel& channel = ranks > network.ranks_per_host ? network.between_hosts : network.within_host;
  constexpr double kBytes = kChannels * ExactSum::kWords * sizeof(std::uint64_t);
  const double step = channel.latency + settings.costs.send + settings.costs.receive;
  return steps(ranks) *
         ((kSums + kMaxima) * step + kSums * kBytes / channel.bytes_per_second + late(waited, settings));
}

}  // namespace

std::vector<double> product_work(const TileMap& map) {
  std::vector<double> of_block(map.blocks());
  for (std::size_t row = 0; row < map.blocks(); ++row) {
    for (std::size_t column = 0; column < map.blocks(); ++column) {
      const TileBlock& block = map.at(std::min(row, column), std::max(row, column));
      const auto tiles = static_cast<double>(map.first_of_block(column + 1) - map.first_of_block(column));
      of_block[row] += tiles * row_work(block.mixed, block.visible);
    }
  }
  std::vector<double> work;
  for (std::size_t row = 0; row < map.side(); ++row) work.push_back(of_block[map.block_of(row)]);
  return work;
}

IterationTimes model_iteration(std::size_t elements, std::span<const double> work, const RowOwners& owners,
                               const SolveCosts& costs, const JobSettings& settings) {
  IterationTimes times;
  double slowest = 0;
  for (int rank = 0; rank < owners.ranks(); ++rank) {
    const TileRows rows = owners.rows(rank);
    double tiles = 0;
    for (std::size_t row = rows.first; row < rows.last; ++row) tiles += work[row];
    const double speed = settings.speed[static_cast<std::size_t>(rank)];
    const double product = tiles * costs.lit_tile / speed;
    const double vectors =
        costs.unknown * static_cast<double>(std::min(elements, rows.size() * kTileSize)) / speed;
    times.rows_largest = std::max(times.rows_largest, product);
    times.rows_mean += product / owners.ranks();
    times.vectors = std::max(times.vectors, vectors);
    slowest = std::max(slowest, product + vectors);
  }
  times.exchange = exchange_seconds(elements, settings);
  times.sums = sums_seconds(times.rows_largest - times.rows_mean, settings);
  times.seconds = slowest + times.exchange + times.sums;
  return times;
}

}  // namespace fluxel::bench
