#pragma once

#include <chrono>

#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Wall-clock time since a moment. Where it decides the root's counts, so that all ranks decide alike. The
/// communicator must outlive this.
class RootClock {
 public:
  using Clock = std::chrono::steady_clock;

  explicit RootClock(const Communicator& communicator, Clock::time_point start = Clock::now())
      : communicator_(communicator), start_(start) {}

  /// By this rank's clock [s].
  [[nodiscard]] double own_seconds() const;
  /// Collective: by the root's [s].
  [[nodiscard]] double seconds() const;

 private:
  const Communicator& communicator_;
  Clock::time_point start_;
};

}  // namespace fluxel
