#include "mpi_master/communication/node_team.hpp"

#include <atomic>

#include "mpi_master/scheduling/back_off.hpp"

namespace fluxel {

namespace {

// Only without a lock is it the same for two processes.
using Shared = std::atomic_ref<std::uint64_t>;
static_assert(Shared::is_always_lock_free);

}  // namespace

NodeTeam::NodeTeam(const Communicator& node)
    : ranks_(static_cast<std::uint64_t>(node.size())), board_(node, 1) {
  if (node.is_root()) board() = {};
  board_.publish();
}

void NodeTeam::call(NodeTask task) {
  // The others sleep, so nobody counts.
  board().finished.fill(0);
  board().task = static_cast<std::uint64_t>(task);
  Shared(board().calls).store(++heard_, std::memory_order_release);
}

NodeTask NodeTeam::next() {
  ++heard_;
  for (BackOff pause; Shared(board().calls).load(std::memory_order_acquire) != heard_;) pause.wait();
  return static_cast<NodeTask>(board().task);
}

void NodeTeam::wish_to_stop() { Shared(board().stop_wished).store(1, std::memory_order_relaxed); }

bool NodeTeam::is_stop_wished() const {
  return Shared(board().stop_wished).load(std::memory_order_relaxed) != 0;
}

void NodeTeam::finish(std::size_t part) {
  Shared(board().finished[part]).fetch_add(1, std::memory_order_release);
}

bool NodeTeam::is_finished(std::size_t part) const {
  return Shared(board().finished[part]).load(std::memory_order_acquire) == ranks_;
}

}  // namespace fluxel
