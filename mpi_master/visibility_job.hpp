#pragma once

#include <cstdint>
#include <span>

#include "core/element.hpp"
#include "core/progress.hpp"
#include "mpi_master/communicator.hpp"
#include "mpi_master/dealt_tiles.hpp"
#include "mpi_master/row_owners.hpp"
#include "mpi_master/tile_sample.hpp"
#include "visibility/tile_store.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {

/// Totals over all ranks.
struct VisibilityCounts {
  std::uint64_t rays = 0;
  std::uint64_t tiles_uniform = 0;
  std::uint64_t tiles_mixed = 0;
  std::uint64_t message_bytes = 0;  ///< of tiles sent between ranks
  std::uint64_t store_bytes = 0;    ///< of all ranks' TileStore::bytes
};

struct Visibility {
  RowOwners owners;
  TileStore store;  ///< of the rows that this rank owns
  VisibilityCounts counts;
  DealtTiles dealt;
  std::uint64_t hash = 0;  ///< of the logical bits in canonical order: the same for every number of ranks
};

/// Collective: the visibility of all pairs. Each unordered pair is traced once; a finished tile goes to the
/// owners of its rows and of its columns.
[[nodiscard]] Visibility compute_visibility(const Communicator& communicator, const TileTracer& tracer,
                                            const RowCosts& costs, int threads, Progress& progress);

}  // namespace fluxel
