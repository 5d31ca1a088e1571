#pragma once

#include "core/options.hpp"
#include "mpi_master/communicator.hpp"

namespace fluxel {

/// Collective, between steps in which ranks need each other: where a signal has asked any rank to stop, all
/// throw StopRequest. SIGUSR1, to which only the visibility has something to write (rounds of a hierarchy are
/// written as they end), is told so without --checkpoint.
void heed_signals(const Communicator& world, const Options& options);

}  // namespace fluxel
