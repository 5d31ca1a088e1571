#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/simulate/engine.hpp"
#include "bench/simulate/tile_map.hpp"
#include "mpi_master/scheduling/row_owners.hpp"

namespace fluxel::bench {

/// What one can do otherwise than the program does.
struct Design {
  std::string name = "as it is";
  bool dealt_anew = true;  ///< rows, by exact counts of their tiles; else owned by the forecast's parts
};

struct SolveCosts {
  double lit_tile = 0;  ///< product with a tile that is wholly visible, three channels [s]
  double unknown = 0;   ///< vector operations of an iteration, by the rank that has the unknown [s]
};

/// An iteration of conjugate gradients: a product, for which the power of all columns is exchanged first,
/// then the vectors and their sums.
struct IterationTimes {
  double rows_mean = 0, rows_largest = 0;  ///< product of a rank's rows [s]
  double vectors = 0;                      ///< of the rank that has most [s]
  double exchange = 0;                     ///< of the power [s]
  double sums = 0;                         ///< sums and maxima of all ranks, with what sleepers are late [s]
  double seconds = 0;                      ///< of the whole iteration
};

/// What a product takes in each row of tiles, all columns (mpi_master/scheduling/tile_sample's row_work), in
/// tiles that are wholly visible.
[[nodiscard]] std::vector<double> product_work(const TileMap& map);

/// `work` is product_work of the scene's map.
[[nodiscard]] IterationTimes model_iteration(std::size_t elements, std::span<const double> work,
                                             const RowOwners& owners, const SolveCosts& costs,
                                             const JobSettings& settings);

}  // namespace fluxel::bench
