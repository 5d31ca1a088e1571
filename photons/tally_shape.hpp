#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/receiver.hpp"

namespace fluxel {

/// What photons are counted at: the sides of elements, fronts, then, where any patch has an active back, the
/// backs; then the cells of receivers, one receiver after another. Each is a slot.
struct TallyShape {
  std::size_t parts = 2;           ///< see photon_numbers.hpp
  std::size_t sides = 0;           ///< of elements; 0: none are measured
  std::vector<std::size_t> cells;  ///< of each receiver
  bool has_squares = false;        ///< of what a photon brings to a cell

  [[nodiscard]] std::size_t first_cell(std::size_t receiver) const {
    std::size_t first = sides;
    for (std::size_t k = 0; k < receiver; ++k) first += cells[k];
    return first;
  }
  [[nodiscard]] std::size_t slots() const { return first_cell(cells.size()); }

  bool operator==(const TallyShape&) const = default;
};

}  // namespace fluxel
