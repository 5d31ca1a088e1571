#include "mpi_master/communication/root_clock.hpp"

#include <limits>
#include <span>

namespace fluxel {

double RootClock::own_seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

double RootClock::seconds() const {
  double seconds = communicator_.is_root() ? own_seconds() : -std::numeric_limits<double>::infinity();
  communicator_.all_max(std::span(&seconds, 1));
  return seconds;
}

}  // namespace fluxel
