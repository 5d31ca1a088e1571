#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/element.hpp"
#include "mpi_master/checkpoint/checkpoint.hpp"
#include "mpi_master/communication/workers.hpp"
#include "mpi_master/scheduling/row_owners.hpp"
#include "mpi_master/scheduling/scheduled_tiles.hpp"
#include "mpi_master/scheduling/tile_sample.hpp"
#include "mpi_master/steps/device_tiles.hpp"
#include "visibility/tile_store.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {

/// Totals over all ranks.
struct VisibilityCounts {
  std::uint64_t rays = 0;  ///< of the tiles that were computed
  std::uint64_t tiles_uniform = 0;
  std::uint64_t tiles_mixed = 0;
  std::uint64_t message_bytes = 0;  ///< of tiles sent between ranks
  std::uint64_t store_bytes = 0;    ///< of all ranks' TileStore::bytes
  std::uint64_t tiles_resumed = 0;  ///< of all, those that an earlier job has kept
  DeviceCounts device;              ///< of those that were computed
};

struct Visibility {
  RowOwners owners;
  TileStore store;  ///< of the rows that this rank owns
  VisibilityCounts counts;
  ScheduleRecord schedule;
  std::vector<DeviceFailure> device_failures;  ///< of GPUs midway, on all ranks
  std::uint32_t makers = kMadeByProcessor;     ///< of StripMaker: all that had a part in the bits
  std::string not_kept;    ///< why strips could not be kept, on all ranks; empty: they are, or need not be
  std::uint64_t hash = 0;  ///< of the logical bits in canonical order: the same for every number of ranks
};

/// Collective: the visibility of all pairs. Each unordered pair is traced once; a finished tile goes to the
/// owners of its rows and of its columns. What the checkpoint has of earlier jobs is taken from there, and
/// finished strips are kept there, by the clock, on signals and at the end. Throws StopRequest on all ranks
/// where a signal has asked to stop, AgreedError where strips could not be kept then.
///
/// `device`, where this rank has one, makes its tiles. When it fails midway the rank goes on by itself, which
/// Visibility::device_failures says; one that is required makes it throw InputError instead.
[[nodiscard]] Visibility compute_visibility(const Workers& workers, const TileTracer& tracer,
                                            const RowCosts& costs, Checkpoint& checkpoint,
                                            DeviceTiles* device);
/// The same, and keeps nothing.
[[nodiscard]] Visibility compute_visibility(const Workers& workers, const TileTracer& tracer,
                                            const RowCosts& costs);

}  // namespace fluxel
