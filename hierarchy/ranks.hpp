#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

namespace fluxel {

/// Ranks that share a task, and what they do together: each call is made by all of them, in the same order.
/// By default there is one rank, for which nothing has to be done.
struct Ranks {
  std::size_t rank = 0, size = 1;

  /// Element-wise over all ranks, in place. Sums are of whole numbers only: sums of floating-point numbers
  /// would depend on the ranks.
  std::function<void(std::span<std::uint64_t>)> sum = [](std::span<std::uint64_t>) {};
  std::function<void(std::span<double>)> max = [](std::span<double>) {};

  /// Everybody's bytes one after another in the order of the ranks.
  std::function<std::vector<std::byte>(std::span<const std::byte>)> gather_bytes =
      [](std::span<const std::byte> mine) { return std::vector<std::byte>(mine.begin(), mine.end()); };

  template <class T>
  [[nodiscard]] std::vector<T> gather(std::span<const T> mine) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::vector<std::byte> all = gather_bytes(std::as_bytes(mine));
    std::vector<T> items(all.size() / sizeof(T));
    if (!all.empty()) std::memcpy(items.data(), all.data(), all.size());
    return items;
  }
};

}  // namespace fluxel
