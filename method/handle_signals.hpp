#pragma once

#include "core/choices.hpp"
#include "core/log.hpp"
#include "core/options.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

struct Options;

/// Whether SIGUSR1 waits for a round's end, and asks for its picture then.
[[nodiscard]] inline bool shows_rounds(const Options& options) {
  return options.method == Method::hierarchical && options.camera && !options.dry_run;
}

/// Collective: throws StopRequest on all ranks where a signal has asked any of them to stop; warns where one
/// asks for a checkpoint that nobody keeps, or for a picture that nobody can make.
void handle_signals(const Communicator& world, const Options& options, Log& log);

}  // namespace fluxel
