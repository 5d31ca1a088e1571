#pragma once

#include <vector>

#include "mpi_master/checkpoint/checkpoint.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/scheduling/row_owners.hpp"
#include "visibility/tile_range.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

/// Collective: puts what the checkpoint has of earlier jobs, whatever ranks wrote it, into the stores of its
/// owners, and adds their makers to the checkpoint's. Each file is read by one rank. Files that are damaged
/// or foreign are named by Checkpoint::warn. No message may be under way. Returns the tiles of all ranks,
/// ascending and disjoint.
[[nodiscard]] std::vector<TileRange> restore_strips(const Communicator& communicator, const RowOwners& owners,
                                                    Checkpoint& checkpoint, TileStore& store);

/// The tiles (row, column >= row) of the rows that a store owns, as far as they have been put.
[[nodiscard]] std::vector<TileRange> held_ranges(const TileStore& store);

}  // namespace fluxel
