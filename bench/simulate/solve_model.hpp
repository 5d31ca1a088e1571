#pragma once

#include "bench/simulate/engine.hpp"
#include "bench/simulate/traced_scene.hpp"
#include "mpi_master/row_owners.hpp"

namespace fluxel::bench {

/// How the ranks give one another their parts of a vector.
enum class GatherKind {
  linear,  ///< every rank sends to every other, as MPI_Iallgatherv of Open MPI 4 does (coll/libnbc)
  hosts    ///< one rank a host receives for all of the host, who share the vector
};

struct SolveCosts {
  double lit_tile = 0;  ///< product with a tile that has visible pairs, three channels [s]
  double unknown = 0;   ///< vector operations of an iteration, made by every rank [s]
};

/// An iteration of conjugate gradients: a product, of which every rank makes its rows in parts, each on its
/// way while the next one is computed, then the vectors.
struct IterationTimes {
  double rows_mean = 0, rows_largest = 0;  ///< product of a rank's rows [s]
  double vectors = 0;
  double gather = 0;   ///< link's and processor's time of the gathers [s]
  double seconds = 0;  ///< of the whole iteration
};

/// Tiles with visible pairs that all rows of the matrix read, both triangles.
[[nodiscard]] double lit_tiles_in_all(const TracedScene& scene);

[[nodiscard]] IterationTimes model_iteration(const TracedScene& scene, const RowOwners& owners,
                                             const SolveCosts& costs, const JobSettings& settings,
                                             GatherKind gather);

}  // namespace fluxel::bench
