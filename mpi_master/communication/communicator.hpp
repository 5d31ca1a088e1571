#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace fluxel {

using Bytes = std::vector<std::byte>;

/// A message that has arrived.
struct Message {
  int source = 0;
  int tag = 0;
  Bytes data;
};

/// What a rank has sent by Communicator::send so far.
struct SentCounts {
  std::uint64_t messages = 0, bytes = 0;
};

/// A rank's items of a vector that all ranks hold.
struct ItemRange {
  std::size_t first = 0, count = 0;
};

/// Whoever has more sends pending waits for some to go, as each holds its message.
inline constexpr std::size_t kMaxPendingSends = 64;

/// A group of ranks and what they do together, without a type of MPI. Collective calls must be made by all
/// ranks. Every MPI error is a std::runtime_error with MPI's text.
class Communicator {
 public:
  [[nodiscard]] int rank() const;
  [[nodiscard]] int size() const;
  [[nodiscard]] bool is_root() const { return rank() == 0; }

  void barrier() const;

  /// The root's bytes for everybody, of any size.
  void broadcast(Bytes& bytes, int root = 0) const;

  /// Element-wise, in place. Sums are of integers only: sums of floating-point numbers would depend on the
  /// ranks.
  void all_min(std::span<double> values) const;
  void all_max(std::span<double> values) const;
  void all_min(std::span<std::uint64_t> values) const;
  void all_min(std::span<std::uint32_t> values) const;
  void all_sum(std::span<std::uint64_t> values) const;

  /// Everybody's items one after another in the order of the ranks.
  /// Throws std::length_error from 2^31 items on.
  template <class T>
  [[nodiscard]] std::vector<T> all_gather(std::span<const T> mine) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const Bytes all = all_gather_bytes(std::as_bytes(mine), sizeof(T));
    std::vector<T> items(all.size() / sizeof(T));
    if (!all.empty()) std::memcpy(items.data(), all.data(), all.size());
    return items;
  }

  /// Starts to give everybody all ranges of a vector, of each rank the one that it has filled; collective, in
  /// the same order on all ranks. The items must stay where they are until finish_gathers has come back.
  /// Throws std::length_error from 2^31 items on.
  template <class T>
  void start_gather(std::span<T> items, std::span<const ItemRange> of_ranks) const {
    static_assert(std::is_trivially_copyable_v<T>);
    start_gather_bytes(std::as_writable_bytes(items), sizeof(T), of_ranks);
  }
  /// Lets what has been started go on, as MPI does only while it is called; does not wait.
  void advance_gathers() const;
  /// Waits for all that has been started.
  void finish_gathers() const;

  /// Starts to send; the bytes are kept until they have gone. At most 1 GiB.
  void send(int target, int tag, Bytes bytes) const;
  [[nodiscard]] const SentCounts& sent() const;
  /// Sends that have not gone yet; kMaxPendingSends are enough to keep the network at work.
  [[nodiscard]] std::size_t pending_sends() const;
  /// The next message that has arrived, if any.
  [[nodiscard]] std::optional<Message> receive() const;
  /// Collective: calls `take` with every message that has been sent to this rank and not been received, until
  /// there is none under way between any ranks. Nothing may be sent meanwhile.
  void receive_all(const std::function<void(const Message&)>& take) const;

  /// Ends all ranks at once with this exit code.
  [[noreturn]] void abort(int code) const;

  /// Collective: the ranks with the same number, in their order here.
  [[nodiscard]] Communicator split(int group) const;

  /// Collective: the same ranks so that those of a host follow one another: hosts by their lowest rank, the
  /// root stays the root. Ranks that give the same number are a host, and must be able to share memory.
  [[nodiscard]] Communicator ordered_by_hosts(int host) const;

  // What follows is of communicators that are ordered by hosts, as that of all ranks is.

  /// The ranks of each host.
  [[nodiscard]] std::span<const ItemRange> hosts() const;
  /// The ranks of this rank's host. The first is its leader: it holds and does what is wanted once a host.
  [[nodiscard]] const Communicator& host() const;
  [[nodiscard]] bool is_leader() const { return host().is_root(); }
  /// The leaders of all hosts, in the order of the hosts; of use to leaders alone.
  [[nodiscard]] const Communicator& leaders() const;

 private:
  friend class MpiSession;
  friend class SharedMemory;
  struct State;
  explicit Communicator(std::shared_ptr<State> state) : state_(std::move(state)) {}
  [[nodiscard]] Bytes all_gather_bytes(std::span<const std::byte> mine, std::size_t item) const;
  void start_gather_bytes(std::span<std::byte> all, std::size_t item,
                          std::span<const ItemRange> of_ranks) const;

  /// MPI's own as its Fortran binding numbers it, for files that know MPI.
  [[nodiscard]] int handle() const;

  std::shared_ptr<State> state_;
};

/// MPI from here to the end of the scope.
class MpiSession {
 public:
  /// Throws std::runtime_error where MPI gives less than funnelled threads.
  MpiSession(int* argc, char*** argv);
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  [[nodiscard]] const Communicator& world() const { return world_; }

 private:
  Communicator world_;
};

/// Version of the MPI library, as "Open MPI v4.1.4".
[[nodiscard]] std::string mpi_version();

}  // namespace fluxel
