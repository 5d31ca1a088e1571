#pragma once

#include "formfactor/tile_examiner.hpp"
#include "mpi_master/scheduling/row_owners.hpp"
#include "mpi_master/scheduling/scheduled_tiles.hpp"
#include "mpi_master/steps/incoming_corrections.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

struct FoundCorrections {
  Corrections corrections;  ///< of the rows that this rank owns
  CorrectionCounts counts;  ///< of all ranks; each pair is examined once
  ScheduleRecord schedule;
};

/// Collective: the corrections of the matrix whose tiles `store` and the other ranks' stores hold. Tiles are
/// assigned as those of the visibility are; a rank that examines a tile it does not hold asks the owner of
/// the row for its bits, and what it finds goes to the owners of the rows. Same values for every number of
/// ranks and threads. Throws StopRequest on all ranks where a signal has asked to stop, AgreedError where a
/// rank has no room for what it finds: `available` of it, or of the machine where that is empty.
[[nodiscard]] FoundCorrections find_corrections(const Workers& workers, const TileExaminer& examiner,
                                                const RowOwners& owners, const TileStore& store,
                                                AvailableBytes available = {});

}  // namespace fluxel
