#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/element.hpp"

namespace fluxel {

/// So few outlines are looked at one by one.
inline constexpr std::size_t kFewOutlines = 8;

/// Outlines of one plane in the cells of a grid, about one a cell: which may have a point is answered by the
/// list of one cell. Queries may run from many threads at once.
class PlaneGrid {
 public:
  /// A box around an outline [m].
  struct Entry {
    glm::dvec3 low, high;
    std::uint32_t number = 0;
  };
  /// With `margin` [m] on all sides.
  template <class Vec>
  [[nodiscard]] static Entry entry(const Outline<Vec>& outline, double margin, std::uint32_t number) {
    glm::dvec3 low(outline.corner[0]), high = low;
    for (std::size_t k = 1; k < outline.corners; ++k) {
      low = glm::min(low, glm::dvec3(outline.corner[k]));
      high = glm::max(high, glm::dvec3(outline.corner[k]));
    }
    return {low - margin, high + margin, number};
  }

  /// At least one entry, of a plane with this normal.
  PlaneGrid(std::span<const Entry> entries, const glm::dvec3& normal);

  /// The numbers of all whose box holds a point of the plane, and of some others; in the order of the
  /// entries.
  [[nodiscard]] std::span<const std::uint32_t> around(const glm::dvec3& point) const {
    const std::size_t cell = cell_of(flat(point));
    return std::span(numbers_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  [[nodiscard]] glm::dvec2 flat(const glm::dvec3& point) const { return {point[axis_[0]], point[axis_[1]]}; }
  /// Beyond the edges, the cell beside them.
  [[nodiscard]] glm::ivec2 column_and_row(const glm::dvec2& at) const {
    return glm::ivec2(glm::clamp(glm::floor((at - low_) * scale_), glm::dvec2(0), glm::dvec2(size_ - 1)));
  }
  [[nodiscard]] std::size_t cell_of(const glm::dvec2& at) const {
    const glm::ivec2 cell = column_and_row(at);
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(cell.x);
  }

  std::array<int, 2> axis_{0, 1};  // those that are not the normal's
  glm::dvec2 low_{0}, scale_{0};   // [m], cells a metre
  glm::ivec2 size_{1};
  std::vector<std::uint32_t> first_;  // of each cell in `numbers_`, and their number
  std::vector<std::uint32_t> numbers_;
};

}  // namespace fluxel
