#pragma once

#include "bench/simulate/engine.hpp"
#include "bench/simulate/solve_model.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel::bench {

/// What messages cost on this machine.
struct MeasuredMessages {
  MessageCosts costs;
  Channel within_host;
};

/// Collective over two ranks or more, of which the first two play: processor time of a send and a receive,
/// latency and bandwidth, a tile into and out of a message.
[[nodiscard]] MeasuredMessages measure_messages(const Communicator& world);

/// Processor time that an iteration's vector operations take for each unknown [s].
[[nodiscard]] double measure_vectors(std::size_t unknowns);

}  // namespace fluxel::bench
