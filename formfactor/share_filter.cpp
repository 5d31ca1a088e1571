#include "formfactor/share_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fluxel {

namespace {

/// For the rounding of single precision, in which heights of pairs may have lost digits that matter to no
/// share near the least.
constexpr float kCaution = 1 - 1e-3f;

/// Of power, so that no light is too bright or too faint for single precision.
double unit_of(const PowerEstimate& power) {
  double most = 0;
  for (const double B : power.B) most = std::max(most, B);
  return most > 0 ? most : 1;
}

/// A power of two that makes the largest coordinate about 1: areas are no numbers in every unit of length.
float scale_of(std::span<const Element> elements) {
  float largest = 0;
  for (const Element& element : elements)
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(element.centroid[axis]));
  return largest > 0 ? std::ldexp(1.0f, -std::ilogb(largest)) : 1.0f;
}

}  // namespace

ShareFilter::ShareFilter(std::span<const Element> elements, const PowerEstimate& power)
    : tiles_(tile_count(elements.size())) {
  const double unit = unit_of(power);
  const float scale = scale_of(elements);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Element& element = elements[i];
    Columns& tile = tiles_[i / kTileSize];
    const std::size_t c = i % kTileSize;
    tile.x[c] = scale * element.centroid.x;
    tile.y[c] = scale * element.centroid.y;
    tile.z[c] = scale * element.centroid.z;
    tile.normal_x[c] = element.normal.x;
    tile.normal_y[c] = element.normal.y;
    tile.normal_z[c] = element.normal.z;
    for (std::size_t unknown = i; unknown < power.B.size(); unknown += elements.size()) {
      const double of_side =
          static_cast<double>(scale * scale * element.area) * std::numbers::inv_pi * power.B[unknown];
      tile.power[c] = std::max(tile.power[c], static_cast<float>(of_side / unit));
      tile.inverse_H[c] = std::max(tile.inverse_H[c], static_cast<float>(unit / power.H[unknown]));
    }
  }
}

std::uint64_t ShareFilter::above(double least, std::size_t i, std::size_t tile) const {
  const Columns& row = tiles_[i / kTileSize];
  const Columns& column = tiles_[tile];
  const std::size_t r = i % kTileSize;
  const float wanted = kCaution * static_cast<float>(least);
  std::array<std::uint8_t, kTileSize> found;
  // Integers instead of branches, so that the compiler takes several columns at a time.
  for (std::size_t c = 0; c < kTileSize; ++c) {
    const float dx = column.x[c] - row.x[r], dy = column.y[c] - row.y[r], dz = column.z[c] - row.z[r];
    const float inverse_r2 = 1 / (dx * dx + dy * dy + dz * dz);
    const float height_column = row.normal_x[r] * dx + row.normal_y[r] * dy + row.normal_z[r] * dz;
    const float height_row = column.normal_x[c] * dx + column.normal_y[c] * dy + column.normal_z[c] * dz;
    const float cosines = std::abs(height_column * height_row) * inverse_r2;
    const float power =
        std::max(column.power[c] * row.inverse_H[r], row.power[r] * column.inverse_H[c]) * inverse_r2;
    // What is not a number is looked at.
    found[c] = static_cast<std::uint8_t>(!(cosines * power <= wanted));
  }
  std::uint64_t word = 0;
  for (std::size_t c = 0; c < kTileSize; ++c) word |= std::uint64_t{found[c]} << c;
  return word;
}

}  // namespace fluxel
