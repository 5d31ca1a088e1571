#include "mpi_master/communication/shared_memory.hpp"

#include <fmt/format.h>
#include <mpi.h>
#include <sys/mman.h>

#include <atomic>
#include <cstdint>
#include <exception>
#include <new>

#include "core/error.hpp"

namespace fluxel {

namespace {

/// Of the first byte: a line of the processor's caches.
constexpr std::size_t kAlignment = 64;

std::byte* aligned(std::byte* at) {
  const auto past = reinterpret_cast<std::uintptr_t>(at) % kAlignment;
  return past == 0 ? at : at + (kAlignment - past);
}

/// A rank that is alone needs no window, and none of the host's shared memory, of which containers give
/// little.
std::byte* map_alone(std::size_t bytes) {
  void* mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  return static_cast<std::byte*>(mapped);
}

/// All of it is the leader's in the eyes of MPI, so that it is one piece.
std::byte* map_together(MPI_Comm host, bool leads, std::size_t bytes, MPI_Win& window) {
  void* own = nullptr;
  const auto given = static_cast<MPI_Aint>(leads ? bytes + kAlignment : 0);
  const int code = MPI_Win_allocate_shared(given, 1, MPI_INFO_NULL, host, &own, &window);
  if (code != MPI_SUCCESS)
    throw InputError(
        fmt::format("not enough shared memory: {:.3g} GiB are wanted together by the ranks of a host (make "
                    "/dev/shm larger, for a container by --shm-size, or start one rank a host)",
                    static_cast<double>(bytes) * 0x1p-30));
  void* first = nullptr;
  MPI_Aint size = 0;
  int unit = 0;
  if (MPI_Win_shared_query(window, 0, &size, &unit, &first) != MPI_SUCCESS)
    throw std::runtime_error("MPI_Win_shared_query failed");
  return aligned(static_cast<std::byte*>(first));
}

}  // namespace

struct SharedMemory::State {
  Communicator host;
  std::size_t bytes;
  MPI_Win window = MPI_WIN_NULL;
  std::byte* data = nullptr;

  State(const Communicator& of_host, std::size_t size) : host(of_host), bytes(size) {
    // MPI waits without sleep.
    host.barrier();
    data = host.size() == 1 ? map_alone(bytes)
                            : map_together(MPI_Comm_f2c(host.handle()), host.is_root(), bytes, window);
  }
  ~State() {
    if (host.size() == 1) {
      munmap(data, bytes);
    } else if (std::uncaught_exceptions() == 0) {
      // Freeing waits for all; a rank that fails must not, since they may wait for it elsewhere. What it
      // leaves goes with the processes.
      host.barrier();
      MPI_Win_free(&window);
    }
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

SharedMemory::SharedMemory(const Communicator& host, std::size_t bytes)
    : state_(bytes > 0 ? std::make_shared<State>(host, bytes) : nullptr) {}

std::byte* SharedMemory::data() const { return state_ ? state_->data : nullptr; }

void SharedMemory::publish() const {
  if (!state_) return;
  std::atomic_thread_fence(std::memory_order_release);
  state_->host.barrier();
  std::atomic_thread_fence(std::memory_order_acquire);
}

}  // namespace fluxel
