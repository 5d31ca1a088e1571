#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Memory that the ranks of a host hold together. It goes with the last of them; where a rank goes because it
/// fails, it waits for nobody.
class SharedMemory {
 public:
  SharedMemory() = default;
  /// Collective on the ranks of `host`. Nobody has touched it yet, so it takes no memory until somebody does.
  /// Throws InputError where the host has less.
  SharedMemory(const Communicator& host, std::size_t bytes);

  [[nodiscard]] std::byte* data() const;

  /// Collective on the host: what any of its ranks has written, all see from here on.
  void publish() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// An array in such memory. What its items are is undefined until they are set; the host's ranks agree on who
/// writes which, and publish before others read.
template <class T>
class SharedArray {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  SharedArray() = default;
  /// Collective on the ranks of `host`, which give the same size.
  SharedArray(const Communicator& host, std::size_t size) : memory_(host, size * sizeof(T)), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<T> items() { return {reinterpret_cast<T*>(memory_.data()), size_}; }
  [[nodiscard]] std::span<const T> items() const {
    return {reinterpret_cast<const T*>(memory_.data()), size_};
  }

  void publish() const { memory_.publish(); }

 private:
  SharedMemory memory_;
  std::size_t size_ = 0;
};

}  // namespace fluxel
