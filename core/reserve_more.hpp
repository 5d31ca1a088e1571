#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fluxel {

/// Room for so many more items. A vector that is full doubles by itself: of what fills most of the memory
/// that is too much.
template <class T>
void reserve_more(std::vector<T>& items, std::size_t more) {
  constexpr std::size_t kPart = 16;
  if (items.capacity() - items.size() < more)
    items.reserve(items.size() + std::max(more, items.size() / kPart));
}

}  // namespace fluxel
