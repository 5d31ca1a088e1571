#pragma once

#include <cstdint>
#include <vector>

#include "mpi_master/communication/communicator.hpp"
#include "reference/wave.hpp"

namespace fluxel {

/// What a wave of paths found.
struct MeasuredWave {
  std::vector<Rgb> means;  ///< of each sensor
  std::uint64_t rays = 0;  ///< of all ranks
};

/// Collective: measure_wave for all sensors, which are the same on all ranks, as the result is. The ranks and
/// their threads trace a part each.
[[nodiscard]] MeasuredWave trace_wave(const Communicator& communicator, const Sensors& sensors,
                                      const Wave& wave, int threads);

}  // namespace fluxel
