#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/simulate/engine.hpp"
#include "bench/simulate/tile_map.hpp"
#include "mpi_master/scheduling/row_owners.hpp"

namespace fluxel::bench {

/// How a design differs from what the program does.
struct Design {
  std::string name = "as it is";
  bool owners_by_counts = false;  ///< rows owned by exact counts of their tiles, not by the forecast's parts
  bool own_vectors = false;  ///< a rank works on its own part of the vectors, sums are gathered by tile row
  bool gather_by_ranks =
      false;  ///< each rank receives whole vectors, not one rank a host for all, who share them
};

struct SolveCosts {
  double lit_tile = 0;  ///< product with a tile that has visible pairs, three channels [s]
  double unknown = 0;   ///< vector operations of an iteration, made by every leader of a host [s]
};

/// An iteration of conjugate gradients: a product, of which every rank makes its rows in parts, each on its
/// way while the next one is computed, then the vectors.
struct IterationTimes {
  double rows_mean = 0, rows_largest = 0;  ///< product of a rank's rows [s]
  double vectors = 0;
  double gather = 0;   ///< link's and processor's time of the gathers [s]
  double seconds = 0;  ///< of the whole iteration
};

/// Tiles with visible pairs that each row of tiles reads, all columns.
[[nodiscard]] std::vector<double> lit_tiles(const TileMap& map);

/// `lit` is lit_tiles of the scene's map.
[[nodiscard]] IterationTimes model_iteration(std::size_t elements, std::span<const double> lit,
                                             const RowOwners& owners, const SolveCosts& costs,
                                             const JobSettings& settings, const Design& design);

}  // namespace fluxel::bench
