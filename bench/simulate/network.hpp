#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fluxel::bench {

/// A way for messages: a message of b bytes arrives latency + b / bytes_per_second after it began to leave.
struct Channel {
  double latency = 0;  ///< [s]
  double bytes_per_second = 1;
};

/// Hosts of equal numbers of ranks, each with one link to a switch that never is the bottleneck.
struct Network {
  std::string name;
  Channel between_hosts, within_host;
  double message_gap = 0;  ///< that a host's link needs from one message to the next at least [s]
  int ranks_per_host = 1;
};

/// Messages under way: those that leave or reach one host wait for one another.
class Traffic {
 public:
  Traffic(const Network& network, int ranks);

  [[nodiscard]] bool same_host(int from, int to) const { return host_of(from) == host_of(to); }

  /// When a message within a host is there that is handed over at `time` [s].
  [[nodiscard]] double arrival_within_host(double bytes, double time) const;

  /// When a message to another host has left and come to the link of its target. To be called in the order of
  /// time, as is arrival, since links serve what comes first.
  [[nodiscard]] double reach(int from, double bytes, double time);
  /// When a message that reached the link of its target at `time` is there: it flows through both links at
  /// once, and only what came before it holds it up.
  [[nodiscard]] double arrival(int to, double bytes, double time);

 private:
  [[nodiscard]] double busy_seconds(double bytes) const;
  [[nodiscard]] std::size_t host_of(int rank) const {
    return static_cast<std::size_t>(rank / network_.ranks_per_host);
  }

  Network network_;
  std::vector<double> leaving_until_, arriving_until_;  // by host [s]
};

}  // namespace fluxel::bench
