#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/choices.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// A rank's GPU.
struct RankDevice {
  int number = 0;
  std::string name;        ///< empty: it has none
  std::size_t memory = 0;  ///< [bytes] that the rank may use, of what is free
  std::string why_not;     ///< a sentence where it has none

  [[nodiscard]] bool found() const { return !name.empty(); }
};

/// Collective: gives the ranks of a host its GPUs in turn, each an even share of the memory.
[[nodiscard]] RankDevice find_rank_device(const Communicator& host);

/// A rank whose GPU could not be used, or was given up, and why: a sentence.
struct DeviceFailure {
  int rank = 0;
  std::string reason;
};

/// Collective: those of all ranks, ascending. `own`: this rank's reason; empty: its GPU has not failed.
[[nodiscard]] std::vector<DeviceFailure> device_failures_of_all(const Communicator& communicator,
                                                                const std::string& own);

/// The GPUs of a job.
struct JobDevices {
  int ranks = 0;                       ///< that have one
  std::vector<std::string> names;      ///< different ones, on the root
  std::vector<DeviceFailure> without;  ///< ranks that have none, where they are wanted
};

/// Collective: gives the ranks of a host its GPUs in turn, each an even share of the memory, and calls `take`
/// where a rank has one; where that throws cuda::DeviceError the rank has none that can do it. With
/// Device::cuda throws AgreedError where a rank has none; with automatic such ranks go without; with cpu all
/// do.
[[nodiscard]] JobDevices find_job_devices(const Communicator& world, Device wanted,
                                          const std::function<void(const RankDevice&)>& take);

/// Runs the work; what the device could not do, as a sentence, or nothing.
[[nodiscard]] std::string device_failure_of(const std::function<void()>& work);

}  // namespace fluxel
