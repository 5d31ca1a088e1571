#pragma once

#include <functional>

#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Exit code of a run that a signal has stopped: the EX_TEMPFAIL of sysexits.h, try again.
inline constexpr int kStopped = 75;

/// Does the work of one rank and returns its exit code. What the work throws is said on standard error, once:
/// an AgreedError by the root, and all ranks return 2; a StopRequest by the root, and all return kStopped;
/// anything else by the rank that failed alone, which then ends all ranks at once, with 2 for bad input and
/// for memory that is not there, else with 1.
int guarded(const Communicator& world, const std::function<int()>& work);

}  // namespace fluxel
