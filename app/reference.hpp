#pragma once

#include <chrono>

#include "app/command_line.hpp"
#include "core/progress.hpp"
#include "method/stopwatch.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Collective: `fluxel reference`. The request is read on the root alone; `start` is when the command line
/// began to be read. Measures elements, picture and receivers one after another, writes each as soon as it is
/// measured, and reference.json at the end. Returns 0, 3 where a target error was not reached, or 75 after
/// SIGUSR2: what has been measured until then is written.
[[nodiscard]] int run_reference(const Communicator& world, const ReferenceRequest& request,
                                ProgressDisplay& display, Stopwatch::Clock::time_point start);

}  // namespace fluxel
