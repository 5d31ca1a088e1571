#pragma once

#include "core/progress.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Who does a collective step, and whom its progress is reported to.
struct Workers {
  const Communicator& communicator;
  int threads;  ///< of this rank
  Progress& progress;
};

}  // namespace fluxel
