#pragma once

#include <functional>
#include <stdexcept>

#include "core/error.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// An input error that all ranks know of and throw together: the root says it, nobody waits for anybody.
class AgreedError : public InputError {
 public:
  using InputError::InputError;
};

/// A signal asked to stop, all ranks know and throw this together: the root says what is kept.
class StopRequest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Collective: every rank works; where any of them throws InputError all throw AgreedError with the message
/// of the lowest one. Other exceptions pass through on their rank alone, which must end the job.
void agree(const Communicator& communicator, const std::function<void()>& work);

/// As agree, with the work on the root alone.
void on_root(const Communicator& communicator, const std::function<void()>& work);

/// Collective: whether a signal has asked any rank to stop.
[[nodiscard]] bool anybody_stops(const Communicator& communicator);

}  // namespace fluxel
