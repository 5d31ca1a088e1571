#pragma once

#include <string>

#include "bench/simulate/message_costs.hpp"

namespace fluxel::bench {

/// What has been measured on one machine, as `simulate machine` writes it.
struct MachineFacts {
  MeasuredMessages messages;
  SolveCosts solve;
};

/// As JSON. Throw InputError for a file that cannot be written, or lacks something.
void write_machine(const std::string& file, const MachineFacts& facts);
[[nodiscard]] MachineFacts read_machine(const std::string& file);

/// Networks of the simulation. The machine's own, one host; and two of typical figures, hosts of 32 ranks:
/// InfiniBand EDR and 10 Gb/s Ethernet, where the kernel's sockets make each message dearer.
[[nodiscard]] JobSettings on_this_machine(const MachineFacts& facts, int ranks, int cores);
[[nodiscard]] JobSettings on_infiniband(const MachineFacts& facts, int ranks);
[[nodiscard]] JobSettings on_ethernet(const MachineFacts& facts, int ranks);

}  // namespace fluxel::bench
