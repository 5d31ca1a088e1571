#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Where a rank runs.
struct RankPlace {
  std::string host;
  std::string cpus;  ///< its CPU set, as "0-3,8"
  int threads = 1;   ///< that it will run
  int ranks_on_host = 1;
  int cpu_count = 1;          ///< of its CPU set
  bool one_core = false;      ///< its CPU set is of one core, with all that core's hardware threads or some
  int idle_cpus_on_host = 0;  ///< which the ranks there may use, and none is bound to
};

/// Collective: the place of every rank. With `threads` 0 a rank gets the CPUs of its set, divided among the
/// ranks of its host that have the same set.
[[nodiscard]] std::vector<RankPlace> rank_places(const Communicator& communicator, int threads);

/// Processor time of all threads of this process so far, in the program and in the system [s].
[[nodiscard]] double processor_seconds();

/// Collective: the same of all ranks together [s].
[[nodiscard]] double all_processor_seconds(const Communicator& communicator);

/// Largest resident set of this process so far [bytes].
[[nodiscard]] std::uint64_t peak_resident_bytes();

/// What this process holds now, where memory that several share counts in equal parts; 0 where the system
/// does not tell [bytes].
[[nodiscard]] std::uint64_t proportional_bytes();

/// What the control group (version 2) with this folder leaves of its memory limit, cached files that can be
/// given up not counted as used; the largest number where it has no limit [bytes].
[[nodiscard]] std::uint64_t bytes_left_in_group(const std::filesystem::path& folder);

/// What this process can still take, of the host's memory, its control groups and its limits, where the ranks
/// of a host share alike [bytes].
[[nodiscard]] std::uint64_t available_bytes(int ranks_on_host);

/// Asks for the same each time.
using AvailableBytes = std::function<std::uint64_t()>;

/// Collective: of this rank, whose host's ranks share alike.
[[nodiscard]] AvailableBytes available_here(const Communicator& communicator);

}  // namespace fluxel
