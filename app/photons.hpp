#pragma once

#include <chrono>

#include "app/command_line.hpp"
#include "core/progress.hpp"
#include "method/stopwatch.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Collective: `fluxel photons`. The request is read on the root alone; `start` is when the command line
/// began to be read. Writes what elements and receivers have received, the tally, and photons.json. Returns
/// 0, 3 where an error that was asked for was not reached or no photon met anything, or 75 after SIGUSR2:
/// what there is until then is written.
[[nodiscard]] int run_photons(const Communicator& world, const PhotonsRequest& request,
                              ProgressDisplay& display, Stopwatch::Clock::time_point start);

}  // namespace fluxel
