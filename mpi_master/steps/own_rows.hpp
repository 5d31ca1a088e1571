#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "mpi_master/communication/host_gather.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

/// What a rank has of vectors of unknowns: the sides of the elements of its tile rows, fronts, then backs.
struct OwnRows {
  std::size_t first = 0, count = 0;  ///< elements
  std::size_t sides = 1;

  OwnRows(const TileRows& rows, std::size_t elements, bool two_sided)
      : first(std::min(rows.first * kTileSize, elements)),
        count(std::min(rows.last * kTileSize, elements) - first),
        sides(two_sided ? 2 : 1) {}

  [[nodiscard]] std::span<const Element> of_elements(std::span<const Element> all) const {
    return all.subspan(first, count);
  }

  /// Of a vector that has an entry for each unknown, or none.
  template <class T>
  [[nodiscard]] std::vector<T> of(std::span<const T> all) const {
    std::vector<T> own;
    for (std::size_t side = 0; side < sides && !all.empty(); ++side) {
      const std::span<const T> part = all.subspan(side * (all.size() / sides) + first, count);
      own.insert(own.end(), part.begin(), part.end());
    }
    return own;
  }

  /// The number among all unknowns of one of these.
  [[nodiscard]] std::size_t unknown_of_all(std::size_t own, std::size_t elements) const {
    return own / count * elements + first + own % count;
  }

  /// Collective: the opposite of `of`, held once a host.
  template <class T>
  [[nodiscard]] SharedArray<T> gather(const Communicator& world, const std::vector<T>& own) const {
    return gather_on_hosts(world, std::span<const T>(own), sides);
  }
};

}  // namespace fluxel
