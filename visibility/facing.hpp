#pragma once

#include <array>
#include <cstdint>

#include "visibility/tile_points.hpp"

namespace fluxel {

/// Where the columns of a tile lie, seen from one row: words of column bits.
struct FacingWords {
  std::array<std::uint64_t, 2> of_row{};     ///< by side: the column lies on that side of the row
  std::array<std::uint64_t, 2> of_column{};  ///< by side: the row lies on that side of the column
};

/// A point lies on a side of an element where it is more than `least_height` [m] off the element's plane.
/// Columns behind the last element of a tile have bits without meaning.
[[nodiscard]] FacingWords facing_words(const TilePoints& rows, std::size_t row, const TilePoints& columns,
                                       float least_height);

}  // namespace fluxel
