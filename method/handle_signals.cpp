#include "method/handle_signals.hpp"

#include <fmt/format.h>

#include <array>

#include "core/options.hpp"
#include "core/signals.hpp"
#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

void handle_signals(const Communicator& world, const Options& options, Log& log) {
  const bool waits = shows_rounds(options);
  std::array<std::uint64_t, 2> asked{stop_requested() ? 1u : 0u, !waits && take_snapshot_request() ? 1u : 0u};
  world.all_sum(asked);
  if (asked[0] > 0)
    throw StopRequest(
        options.checkpoint.empty()
            ? "stopped by a signal; nothing is kept, as there is no --checkpoint"
            : fmt::format("stopped by a signal; what is finished stands in {}: go on with --resume",
                          options.checkpoint));
  if (asked[1] == 0) return;
  if (options.method == Method::hierarchical)
    log.warn("SIGUSR1 asks for a picture, and this run has no camera or is a dry one");
  else if (options.checkpoint.empty())
    log.warn("SIGUSR1 asks for a checkpoint, but there is no --checkpoint");
}

}  // namespace fluxel
