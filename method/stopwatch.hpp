#pragma once

#include <chrono>
#include <utility>

#include "mpi_master/communication/machine.hpp"

namespace fluxel {

/// What a phase took on this rank [s].
struct PhaseTime {
  double wall = 0;
  double processor = 0;  ///< of all threads, in the program and in the system

  PhaseTime& operator+=(const PhaseTime& other) {
    wall += other.wall;
    processor += other.processor;
    return *this;
  }
};

/// Time since the last call, for phase after phase.
class Stopwatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// From now on.
  Stopwatch() : last_(Clock::now()), last_processor_(processor_seconds()) {}
  /// From the start of the program, which was then.
  explicit Stopwatch(Clock::time_point start) : last_(start) {}

  PhaseTime lap() {
    const auto now = Clock::now();
    const double processor = processor_seconds();
    return {std::chrono::duration<double>(now - std::exchange(last_, now)).count(),
            processor - std::exchange(last_processor_, processor)};
  }

 private:
  Clock::time_point last_;
  double last_processor_ = 0;
};

}  // namespace fluxel
