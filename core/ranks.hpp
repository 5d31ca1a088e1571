#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>
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

  /// Whether this rank makes what those of its host hold together.
  bool leads_host = true;
  /// The bytes of the host's leader for all of its ranks, which give as many of theirs. They hold them
  /// together from now on, where the system has a way to do so; what a rank writes to them afterwards is seen
  /// by that rank alone.
  std::function<void(std::span<std::byte>)> share_bytes = [](std::span<std::byte>) {};
  /// Likewise, whatever others have; they get room for a part more. In parts, so that what others make room
  /// for is not all there beside what is shared.
  template <class T>
  void share(std::vector<T>& items) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t count = leads_host ? items.size() : 0;
    share_bytes(std::as_writable_bytes(std::span(&count, 1)));
    if (!leads_host) {
      items.clear();
      items.reserve(count + count / kRoom);
    }
    constexpr std::size_t kPart = (std::size_t{1} << 26) / sizeof(T) + 1;
    for (std::size_t first = 0; first < count; first += kPart) {
      const std::size_t last = std::min<std::size_t>(count, first + kPart);
      if (!leads_host) items.resize(last);
      share_bytes(std::as_writable_bytes(std::span(items).subspan(first, last - first)));
    }
  }
  static constexpr std::size_t kRoom = 16;

  template <class T>
  [[nodiscard]] std::vector<T> gather(std::span<const T> mine) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::vector<std::byte> all = gather_bytes(std::as_bytes(mine));
    std::vector<T> items(all.size() / sizeof(T));
    if (!all.empty()) std::memcpy(items.data(), all.data(), all.size());
    return items;
  }
};

/// Items of all ranks that each holds at once, where more than it may hold pass through it.
inline constexpr std::size_t kGatheredAtOnce = std::size_t{1} << 16;

/// Calls `take` with everybody's items, one by one and in the same order on all ranks.
template <class T, class Take>
void gather_in_parts(const Ranks& ranks, std::span<const T> mine, const Take& take) {
  const std::size_t size = std::max<std::size_t>(1, kGatheredAtOnce / ranks.size);
  const std::size_t own_parts = (mine.size() + size - 1) / size;
  auto parts = static_cast<double>(own_parts);
  ranks.max(std::span(&parts, 1));
  for (std::size_t part = 0; static_cast<double>(part) < parts; ++part) {
    const std::span<const T> rest = mine.subspan(std::min(mine.size(), part * size));
    for (const T& item : ranks.gather(rest.first(std::min(rest.size(), size)))) take(item);
  }
}

/// Everybody's items shared out anew: ranks take turns.
template <class T>
[[nodiscard]] std::vector<T> distribute(const Ranks& ranks, std::vector<T> mine) {
  if (ranks.size == 1) return mine;
  std::vector<T> distributed;
  std::size_t turn = 0;
  gather_in_parts(ranks, std::span<const T>(mine), [&](const T& item) {
    if (turn++ % ranks.size == ranks.rank) distributed.push_back(item);
  });
  return distributed;
}

/// Whether it is so on any rank.
[[nodiscard]] inline bool is_any(const Ranks& ranks, bool here) {
  double any = here ? 1 : 0;
  ranks.max(std::span(&any, 1));
  return any > 0;
}

}  // namespace fluxel
