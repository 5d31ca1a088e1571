#pragma once

#include "core/ranks.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// The ranks of a communicator that is ordered by hosts, which must outlive them.
[[nodiscard]] Ranks ranks_of(const Communicator& communicator);

}  // namespace fluxel
