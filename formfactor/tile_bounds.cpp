#include "formfactor/tile_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "visibility/tile.hpp"

namespace fluxel {

namespace {

double squared_gap(const TileShape& a, const TileShape& b) {
  const glm::vec3 gap = glm::max(glm::vec3(0), glm::max(a.low - b.high, b.low - a.high));
  return static_cast<double>(glm::dot(gap, gap));
}

}  // namespace

TileShape tile_shape(std::span<const Element> elements, std::size_t tile) {
  TileShape shape;
  for (const Element& element : elements.subspan(tile * kTileSize, rows_of_tile(tile, elements.size()))) {
    shape.low = glm::min(shape.low, element.centroid);
    shape.high = glm::max(shape.high, element.centroid);
    shape.area = std::max(shape.area, static_cast<double>(element.area));
    shape.variance = std::max(shape.variance, flat_shape(element).moments.trace());
  }
  return shape;
}

TilePower tile_power(std::span<const Element> elements, std::size_t tile, const PowerEstimate& power) {
  TilePower found;
  for (std::size_t k = 0; k < rows_of_tile(tile, elements.size()); ++k) {
    const std::size_t i = tile * kTileSize + k;
    for (std::size_t unknown = i; unknown < power.B.size(); unknown += elements.size()) {
      found.most = std::max(found.most, static_cast<double>(elements[i].area) * power.B[unknown]);
      found.H = std::min(found.H, power.H[unknown]);
    }
  }
  return found;
}

PairRule rule_between(const TileShape& a, const TileShape& b, const KernelRule& kernel) {
  const bool far = point_error(a.variance, b.variance, squared_gap(a, b)) <= kernel.far_error;
  return kernel.rule == PairRule::moments && far ? PairRule::point : kernel.rule;
}

bool may_be_near(const TileShape& a, const TileShape& b, double error) {
  // As moments_error and crossing_error, with all cosines 1.
  const double r2 = squared_gap(a, b);
  const double variances = a.variance + b.variance, area = std::max(a.area, b.area);
  if (5 * variances * variances * area > std::numbers::pi * r2 * r2 * r2 * error) return true;
  const double reach = std::sqrt(6 * variances);
  const double heights = std::min(r2, reach * (std::sqrt(2 * r2) + reach) / 4);
  return area * heights > kCrossingShare * error * std::numbers::pi * r2 * r2;
}

double largest_share(const TileShape& a, const TilePower& power_a, const TileShape& b,
                     const TilePower& power_b) {
  return std::max(power_a.most / power_b.H, power_b.most / power_a.H) /
         (std::numbers::pi * squared_gap(a, b));
}

}  // namespace fluxel
