#pragma once

#include <string>

#include "bench/simulate/traced_scene.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel::bench {

struct TraceSettings {
  std::string scene = "room-of-180-boxes";  ///< one of bench/visibility's
  std::string large_scenes;                 ///< folder of those that the project does not bring
  std::size_t elements = 100'000;           ///< about
  std::size_t blocks = 256;                 ///< on the side of the matrix
  std::size_t tiles_per_block = 8;          ///< traced by chance; all where there are no more
};

/// Traces a sample of tiles of every block on one thread, after the forecast's own sample. `alone` has one
/// rank. Throws InputError for a scene that is not there.
[[nodiscard]] TracedScene trace_scene(const Communicator& alone, const TraceSettings& settings);

}  // namespace fluxel::bench
