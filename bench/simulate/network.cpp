#include "bench/simulate/network.hpp"

#include <algorithm>

namespace fluxel::bench {

Traffic::Traffic(const Network& network, int ranks)
    : network_(network), leaving_until_(host_of(ranks - 1) + 1), arriving_until_(leaving_until_.size()) {}

double Traffic::arrival_within_host(double bytes, double time) const {
  return time + network_.within_host.latency + bytes / network_.within_host.bytes_per_second;
}

double Traffic::reach(int from, double bytes, double time) {
  double& until = leaving_until_[host_of(from)];
  until = std::max(time, until) + busy_seconds(bytes);
  return until + network_.between_hosts.latency;
}

double Traffic::arrival(int to, double bytes, double time) {
  double& until = arriving_until_[host_of(to)];
  until = std::max(time, until + busy_seconds(bytes));
  return until;
}

double Traffic::busy_seconds(double bytes) const {
  return std::max(network_.message_gap, bytes / network_.between_hosts.bytes_per_second);
}

}  // namespace fluxel::bench
