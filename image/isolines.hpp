#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace fluxel {

/// Where values between the middles of a grid's cells are `level`, as straight pieces, in cells from the
/// grid's corner: marching squares (Lorensen & Cline 1987, in two dimensions), with the middle's mean where
/// two ways are open. `values`: row by row, `columns` each; around what is not a number there is no line.
[[nodiscard]] std::vector<std::array<glm::dvec2, 2>> isolines(std::span<const double> values, int columns,
                                                              double level);

}  // namespace fluxel
