#include "bench/simulate/solve_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/rgb.hpp"

namespace fluxel::bench {

namespace {

// As in mpi_master/distributed_operator.cpp.
constexpr std::size_t kMostParts = 8;
constexpr std::size_t kLeastTileRows = 8;

/// Lit tiles of a whole row, all columns, of each block row.
std::vector<double> lit_tiles(const TileMap& map) {
  std::vector<double> lit(map.blocks());
  for (std::size_t row = 0; row < map.blocks(); ++row) {
    for (std::size_t column = 0; column < map.blocks(); ++column) {
      const TileBlock& block = map.at(std::min(row, column), std::max(row, column));
      const auto tiles = static_cast<double>(map.first_of_block(column + 1) - map.first_of_block(column));
      lit[row] += tiles * (block.mixed + block.visible);
    }
  }
  return lit;
}

/// Seconds of all parts' gathers on a host's link and on a rank's processor.
double gather_seconds(const TracedScene& scene, std::size_t parts, const JobSettings& settings,
                      GatherKind kind) {
  const auto ranks = static_cast<double>(settings.speed.size());
  const Network& network = settings.network;
  const double on_host = std::min(ranks, static_cast<double>(network.ranks_per_host));
  const double hosts = std::ceil(ranks / on_host);
  const double vector_bytes = static_cast<double>(scene.elements * sizeof(Rgb));
  const double copies = kind == GatherKind::linear ? on_host : 1;
  const double from_others =
      vector_bytes * copies * (hosts - 1) / hosts / network.between_hosts.bytes_per_second;
  const double within = vector_bytes / network.within_host.bytes_per_second;
  const double peers = kind == GatherKind::linear ? ranks - 1 : hosts - 1;
  const double messages = static_cast<double>(parts) * peers *
                          (settings.costs.send + settings.costs.receive + network.message_gap);
  const double steps = static_cast<double>(parts) * std::ceil(std::log2(std::max(2.0, ranks)));
  return ranks > 1 ? std::max(from_others, within) + messages + steps * network.between_hosts.latency : 0;
}

}  // namespace

double lit_tiles_in_all(const TracedScene& scene) {
  const std::vector<double> lit = lit_tiles(scene.map);
  double all = 0;
  for (std::size_t row = 0; row < scene.map.side(); ++row) all += lit[scene.map.block_of(row)];
  return all;
}

IterationTimes model_iteration(const TracedScene& scene, const RowOwners& owners, const SolveCosts& costs,
                               const JobSettings& settings, GatherKind gather) {
  const std::vector<double> lit = lit_tiles(scene.map);
  IterationTimes times;
  std::size_t fewest_rows = scene.map.side();
  for (int rank = 0; rank < owners.ranks(); ++rank) {
    double tiles = 0;
    for (std::size_t row = owners.rows(rank).first; row < owners.rows(rank).last; ++row)
      tiles += lit[scene.map.block_of(row)];
    const double seconds = tiles * costs.lit_tile / settings.speed[static_cast<std::size_t>(rank)];
    times.rows_largest = std::max(times.rows_largest, seconds);
    times.rows_mean += seconds / owners.ranks();
    fewest_rows = std::min(fewest_rows, owners.rows(rank).size());
  }
  const std::size_t parts = std::clamp<std::size_t>(fewest_rows / kLeastTileRows, 1, kMostParts);
  times.vectors = costs.unknown * static_cast<double>(scene.elements);
  times.gather = gather_seconds(scene, parts, settings, gather);
  // A pipeline of two stages: the first part is computed before any gather, the last is gathered after all.
  const auto count = static_cast<double>(parts);
  times.seconds = times.vectors + std::max(times.rows_largest + times.gather / count,
                                           times.rows_largest / count + times.gather);
  return times;
}

}  // namespace fluxel::bench
