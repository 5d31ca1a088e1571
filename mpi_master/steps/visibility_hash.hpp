#pragma once

#include <cstddef>
#include <cstdint>

#include "mpi_master/communication/communicator.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

/// Collective: the hash of all bits in canonical order, the same for every number of ranks and threads. Of
/// each tile row, its tiles ascending from the diagonal, then of all of these. `store`: of the rows that the
/// rank owns.
[[nodiscard]] std::uint64_t hash_of_visibility(const Communicator& communicator, const TileStore& store,
                                               std::size_t elements, int threads);

}  // namespace fluxel
