#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Memory that the ranks of a node hold together. It goes with the last of them; where a rank goes because it
/// fails, it waits for nobody.
class NodeMemory {
 public:
  NodeMemory() = default;
  /// Collective on the ranks of `node`. Nobody has touched it yet, so it takes no memory until somebody does.
  /// Throws InputError where the node has less.
  NodeMemory(const Communicator& node, std::size_t bytes);

  [[nodiscard]] std::byte* data() const;

  /// Collective on the node: what any of its ranks has written, all see from here on.
  void publish() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// An array in such memory. What its items are is undefined until they are set; the node's ranks agree on who
/// writes which, and publish before others read.
template <class T>
class NodeArray {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  NodeArray() = default;
  /// Collective on the ranks of `node`, which give the same size.
  NodeArray(const Communicator& node, std::size_t size) : memory_(node, size * sizeof(T)), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<T> items() { return {reinterpret_cast<T*>(memory_.data()), size_}; }
  [[nodiscard]] std::span<const T> items() const {
    return {reinterpret_cast<const T*>(memory_.data()), size_};
  }

  void publish() const { memory_.publish(); }

 private:
  NodeMemory memory_;
  std::size_t size_ = 0;
};

}  // namespace fluxel
