#include "bench/simulate/solve_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/rgb.hpp"

namespace fluxel::bench {

namespace {

// As in mpi_master/distributed_operator.cpp.
constexpr std::size_t kMaxParts = 8;
constexpr std::size_t kMinTileRows = 8;

constexpr double kSumsAnIteration = 3;  // dot products and the bound of the error

double steps_of_tree(const JobSettings& settings) {
  return std::ceil(std::log2(static_cast<double>(settings.speed.size())));
}

/// Seconds of all parts' gathers on a host's link and on a rank's processor. Open MPI 4 sends from everyone
/// to everyone (MPI_Iallgatherv of coll/libnbc); leaders do so once for each place of a rank on a host, and
/// copy what goes to and comes from the vectors that their hosts share.
double gather_seconds(std::size_t elements, std::size_t parts, const JobSettings& settings, bool by_ranks) {
  const auto ranks = static_cast<double>(settings.speed.size());
  if (ranks < 2) return 0;
  const Network& network = settings.network;
  const double on_host = std::min(ranks, static_cast<double>(network.ranks_per_host));
  const double hosts = std::ceil(ranks / on_host);
  const double bytes = static_cast<double>(elements * sizeof(Rgb));
  const double from_others =
      bytes * (by_ranks ? on_host : 1) * (hosts - 1) / hosts / network.between_hosts.bytes_per_second;
  const double within = (by_ranks ? 1 : 2) * bytes / network.within_host.bytes_per_second;
  const double messages = static_cast<double>(parts) * (by_ranks ? ranks - 1 : on_host * (hosts - 1)) *
                          (settings.costs.send + settings.costs.receive + network.message_gap);
  return (by_ranks ? std::max(from_others, within) : from_others + within) + messages +
         static_cast<double>(parts) * steps_of_tree(settings) * network.between_hosts.latency;
}

double vector_seconds(std::size_t elements, std::size_t tile_rows, const SolveCosts& costs,
                      const JobSettings& settings, bool own) {
  const double all = costs.unknown * static_cast<double>(elements);
  const auto ranks = static_cast<double>(settings.speed.size());
  if (!own || ranks < 2) return all;
  const Channel& channel = settings.network.between_hosts;
  const double sums = static_cast<double>(tile_rows * sizeof(Rgb)) / channel.bytes_per_second +
                      2 * steps_of_tree(settings) * channel.latency;
  return all / ranks + kSumsAnIteration * sums;
}

}  // namespace

std::vector<double> lit_tiles(const TileMap& map) {
  std::vector<double> of_block(map.blocks());
  for (std::size_t row = 0; row < map.blocks(); ++row) {
    for (std::size_t column = 0; column < map.blocks(); ++column) {
      const TileBlock& block = map.at(std::min(row, column), std::max(row, column));
      const auto tiles = static_cast<double>(map.first_of_block(column + 1) - map.first_of_block(column));
      of_block[row] += tiles * (block.mixed + block.visible);
    }
  }
  std::vector<double> lit;
  for (std::size_t row = 0; row < map.side(); ++row) lit.push_back(of_block[map.block_of(row)]);
  return lit;
}

IterationTimes model_iteration(std::size_t elements, std::span<const double> lit, const RowOwners& owners,
                               const SolveCosts& costs, const JobSettings& settings, const Design& design) {
  IterationTimes times;
  std::size_t fewest_rows = lit.size();
  for (int rank = 0; rank < owners.ranks(); ++rank) {
    double tiles = 0;
    for (std::size_t row = owners.rows(rank).first; row < owners.rows(rank).last; ++row) tiles += lit[row];
    const double seconds = tiles * costs.lit_tile / settings.speed[static_cast<std::size_t>(rank)];
    times.rows_largest = std::max(times.rows_largest, seconds);
    times.rows_mean += seconds / owners.ranks();
    fewest_rows = std::min(fewest_rows, owners.rows(rank).size());
  }
  const std::size_t parts = std::clamp<std::size_t>(fewest_rows / kMinTileRows, 1, kMaxParts);
  times.vectors = vector_seconds(elements, lit.size(), costs, settings, design.own_vectors);
  times.gather = gather_seconds(elements, parts, settings, design.gather_by_ranks);
  // A pipeline of two stages: the first part is computed before any gather, the last is gathered after all.
  const auto count = static_cast<double>(parts);
  times.seconds = times.vectors + std::max(times.rows_largest + times.gather / count,
                                           times.rows_largest / count + times.gather);
  return times;
}

}  // namespace fluxel::bench
