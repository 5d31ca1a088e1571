#include "bench/simulate/network.hpp"

#include <algorithm>

namespace fluxel::bench {

Traffic::Traffic(const Network& network, int ranks)
    : network_(network), leaving_until_(host_of(ranks - 1) + 1), arriving_until_(leaving_until_.size()) {}

double Traffic::arrival(int from, int to, double bytes, double time) {
  const std::size_t source = host_of(from), target = host_of(to);
  if (source == target)
    return time + network_.within_host.latency + bytes / network_.within_host.bytes_per_second;
  const Link& link = network_.between_hosts;
  const double busy = std::max(network_.message_gap, bytes / link.bytes_per_second);
  const double left = std::max(time, leaving_until_[source]) + busy;
  leaving_until_[source] = left;
  // The message flows through both links at once; only what came before it holds it up.
  const double there = std::max(left + link.latency, arriving_until_[target] + busy);
  arriving_until_[target] = there;
  return there;
}

}  // namespace fluxel::bench
