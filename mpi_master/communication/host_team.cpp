#include "mpi_master/communication/host_team.hpp"

#include <atomic>

#include "mpi_master/scheduling/back_off.hpp"

namespace fluxel {

namespace {

// Only without a lock is it the same for two processes.
using Shared = std::atomic_ref<std::uint64_t>;
static_assert(Shared::is_always_lock_free);

}  // namespace

HostTeam::HostTeam(const Communicator& host)
    : ranks_(static_cast<std::uint64_t>(host.size())), board_(host, 1) {
  if (host.is_root()) board() = {};
  board_.publish();
}

void HostTeam::call(TeamTask task) {
  // The others sleep, so nobody counts.
  board().finished.fill(0);
  board().task = static_cast<std::uint64_t>(task);
  Shared(board().calls).store(++heard_, std::memory_order_release);
}

TeamTask HostTeam::next() {
  ++heard_;
  for (BackOff pause; Shared(board().calls).load(std::memory_order_acquire) != heard_;) pause.wait();
  return static_cast<TeamTask>(board().task);
}

void HostTeam::wish_to_stop() { Shared(board().stop_wished).store(1, std::memory_order_relaxed); }

bool HostTeam::is_stop_wished() const {
  return Shared(board().stop_wished).load(std::memory_order_relaxed) != 0;
}

void HostTeam::finish(std::size_t part) {
  Shared(board().finished[part]).fetch_add(1, std::memory_order_release);
}

bool HostTeam::is_finished(std::size_t part) const {
  return Shared(board().finished[part]).load(std::memory_order_acquire) == ranks_;
}

}  // namespace fluxel
