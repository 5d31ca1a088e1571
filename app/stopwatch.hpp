#pragma once

#include <chrono>
#include <utility>

namespace fluxel {

/// Wall-clock seconds since the last call, for phase after phase.
class Stopwatch {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Stopwatch(Clock::time_point start = Clock::now()) : last_(start) {}

  double lap() {
    const auto now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  Clock::time_point last_;
};

}  // namespace fluxel
