#pragma once

#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/steps/visibility_job.hpp"

namespace fluxel {

/// Collective: deals the rows anew by what a product takes in them (row_work), which is known exactly when
/// all tiles are: the forecast tells it from a sample. Tiles that get another owner travel, each once to each
/// rank that shall have it. Where the rank that has most would have hardly less, or a rank has no memory for
/// both stores, all stays as it is.
void deal_rows(const Communicator& communicator, Visibility& visibility);

}  // namespace fluxel
