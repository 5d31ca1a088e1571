#pragma once

#include "core/log.hpp"
#include "core/options.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Collective: throws StopRequest on all ranks where a signal has asked any of them to stop; warns where one
/// asks for a checkpoint that nobody keeps.
void handle_signals(const Communicator& world, const Options& options, Log& log);

}  // namespace fluxel
