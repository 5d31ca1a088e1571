#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mpi_master/communication/shared_memory.hpp"

namespace fluxel {

/// What the ranks of a host are called to do together; `stop` ends the run.
enum class TeamTask : std::uint64_t { apply_grey, apply_rgb, sweep_grey, sweep_rgb, end, stop };

/// The ranks of a host at tasks that their leader calls: everybody does its share part by part, and the
/// leader sees how far all are. What is written before `call` and `finish` is seen by those that they wake.
/// Waiting ranks sleep between looks.
class HostTeam {
 public:
  static constexpr std::size_t kMaxParts = 8;  ///< of a task

  /// Collective on the ranks of `host`.
  explicit HostTeam(const Communicator& host);

  [[nodiscard]] bool has_helpers() const { return ranks_ > 1; }

  /// By the leader, when all parts of the task before are finished.
  void call(TeamTask task);
  /// By the others: the task that the leader calls next.
  [[nodiscard]] TeamTask next();

  /// By the others: a signal has asked this rank to stop, which only the leader can see to.
  void wish_to_stop();
  /// By the leader: whether one of the others wishes it.
  [[nodiscard]] bool is_stop_wished() const;

  /// By everybody: the own share of the part is done.
  void finish(std::size_t part);
  /// By the leader: whether the shares of all are.
  [[nodiscard]] bool is_finished(std::size_t part) const;

 private:
  struct Board {
    std::uint64_t calls, task, stop_wished;
    std::array<std::uint64_t, kMaxParts> finished;  ///< by how many ranks, of each part
  };

  // It is nobody's alone.
  [[nodiscard]] Board& board() const { return board_.items().front(); }

  std::uint64_t ranks_;
  std::uint64_t heard_ = 0;  // calls that this rank has followed
  mutable SharedArray<Board> board_;
};

}  // namespace fluxel
