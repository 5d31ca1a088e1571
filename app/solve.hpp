#pragma once

#include <chrono>

#include "app/command_line.hpp"
#include "core/progress.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Collective: the whole job. The request is read on the root alone. `start` is when the command line began
/// to be read: the load and the whole are timed from there. Returns the exit code, 0 or 3. Throws AgreedError
/// on all ranks for bad input; anything else is thrown by the rank that failed.
int run_solve(const Communicator& world, SolveRequest request, ProgressDisplay& display,
              std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now());

}  // namespace fluxel
