#include "formfactor/contour_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formfactor/pair_rule.hpp"

namespace fluxel {

ContourFilter::ContourFilter(std::span<const Element> elements, double near_error, double crossing_error)
    : tiles_(tile_count(elements.size())),
      near_error_(static_cast<float>(near_error)),
      crossing_error_(static_cast<float>(crossing_error)) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Element& element = elements[i];
    Columns& tile = tiles_[i / kTileSize];
    const std::size_t c = i % kTileSize;
    tile.x[c] = element.centroid.x;
    tile.y[c] = element.centroid.y;
    tile.z[c] = element.centroid.z;
    tile.normal_x[c] = element.normal.x;
    tile.normal_y[c] = element.normal.y;
    tile.normal_z[c] = element.normal.z;
    tile.variance[c] = static_cast<float>(flat_shape(element).moments.trace());
    tile.area[c] = element.area;
  }
}

std::uint64_t ContourFilter::candidates(std::size_t i, std::size_t tile) const {
  const Columns& row = tiles_[i / kTileSize];
  const Columns& column = tiles_[tile];
  const std::size_t r = i % kTileSize;
  std::array<std::uint8_t, kTileSize> found;
  // Integers instead of branches, so that the compiler takes several columns at a time.
  for (std::size_t c = 0; c < kTileSize; ++c) {
    const float dx = column.x[c] - row.x[r], dy = column.y[c] - row.y[r], dz = column.z[c] - row.z[r];
    // By ratios to r^2, which have no unit: sixth powers of lengths are no numbers in every unit.
    const float inverse_r2 = 1 / (dx * dx + dy * dy + dz * dz);
    const float variances = (row.variance[r] + column.variance[c]) * inverse_r2;
    const float area = std::max(row.area[r], column.area[c]) * inverse_r2;
    const int near = int{5 * variances * variances * area > near_error_ * std::numbers::pi_v<float>};
    const float height_column = row.normal_x[r] * dx + row.normal_y[r] * dy + row.normal_z[r] * dz;
    const float height_row = column.normal_x[c] * dx + column.normal_y[c] * dy + column.normal_z[c] * dz;
    const int crosses = int{height_column * height_column < 6 * column.variance[c]} |
                        int{height_row * height_row < 6 * row.variance[r]};
    const float reach = std::sqrt(6 * variances);
    const int matters =
        int{area * reach * (1.415f + reach) > 4 * crossing_error_ * std::numbers::pi_v<float>};
    found[c] = static_cast<std::uint8_t>(near | (crosses & matters));
  }
  std::uint64_t word = 0;
  for (std::size_t c = 0; c < kTileSize; ++c) word |= std::uint64_t{found[c]} << c;
  return word;
}

}  // namespace fluxel
