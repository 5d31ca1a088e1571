#pragma once

#include "app/command_line.hpp"
#include "core/progress.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Collective: says on standard output what the scene holds, what is suspicious of it, and what a solve by
/// the hierarchical method would take; where nothing can be solved, why. The request is read on the root
/// alone. Returns the exit code, 0. Throws AgreedError on all ranks for bad input.
int run_info(const Communicator& world, const InfoRequest& request, ProgressDisplay& display);

}  // namespace fluxel
