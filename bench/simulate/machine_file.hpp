#pragma once

#include <string>

#include "bench/simulate/message_costs.hpp"

namespace fluxel::bench {

/// What has been measured on one machine, as `simulate machine` writes it.
struct MachineFigures {
  MeasuredMessages messages;
  SolveCosts solve;
};

/// As JSON. Throw InputError for a file that cannot be written, or lacks something.
void write_machine(const std::string& file, const MachineFigures& figures);
[[nodiscard]] MachineFigures read_machine(const std::string& file);

/// Networks of the simulation: the machine's own, one host; and two of typical figures, which are
/// assumptions, with hosts of 32 ranks. InfiniBand: 1.5 us, and 12 GB/s, the line rate of EDR (100 Gb/s).
/// Ethernet of 10 Gb/s through the kernel's sockets: 25 us, 1 GB/s, and 3 us more of processor time for each
/// message.
[[nodiscard]] JobSettings on_this_machine(const MachineFigures& figures, int ranks, int cores);
[[nodiscard]] JobSettings on_infiniband(const MachineFigures& figures, int ranks);
[[nodiscard]] JobSettings on_ethernet(const MachineFigures& figures, int ranks);

}  // namespace fluxel::bench
