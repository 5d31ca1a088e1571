#include "subdivision/plane_grid.hpp"

#include <cmath>
#include <limits>

namespace fluxel {

namespace {

/// Of one axis of a rectangle that is to have about so many cells in all.
int cells_along(double length, double other, double cells) {
  const double count = other > 0 ? std::sqrt(cells * length / other) : cells;
  return static_cast<int>(std::clamp(std::ceil(count), 1.0, cells));
}

}  // namespace

PlaneGrid::PlaneGrid(std::span<const Entry> entries, const glm::dvec3& normal) {
  const glm::dvec3 size = glm::abs(normal);
  const int dropped = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  axis_ = {dropped == 0 ? 1 : 0, dropped == 2 ? 1 : 2};
  low_ = flat(entries[0].low);
  glm::dvec2 high = flat(entries[0].high);
  for (const Entry& entry : entries) {
    low_ = glm::min(low_, flat(entry.low));
    high = glm::max(high, flat(entry.high));
  }
  const glm::dvec2 extent = high - low_;
  const auto cells = static_cast<double>(entries.size());
  size_ = {cells_along(extent.x, extent.y, cells), cells_along(extent.y, extent.x, cells)};
  scale_ = glm::dvec2(size_) / glm::max(extent, glm::dvec2(std::numeric_limits<double>::min()));

  const auto visit_cells = [&](const Entry& entry, const auto& visit) {
    const glm::ivec2 from = column_and_row(flat(entry.low)), to = column_and_row(flat(entry.high));
    for (int row = from.y; row <= to.y; ++row)
      for (int column = from.x; column <= to.x; ++column)
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.x) +
              static_cast<std::size_t>(column));
  };
  first_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) + 1, 0);
  for (const Entry& entry : entries) visit_cells(entry, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  numbers_.resize(first_.back());
  std::vector<std::uint32_t> next = first_;
  for (const Entry& entry : entries)
    visit_cells(entry, [&](std::size_t cell) { numbers_[next[cell]++] = entry.number; });
}

}  // namespace fluxel
