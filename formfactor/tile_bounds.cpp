#include "formfactor/tile_bounds.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "visibility/tile.hpp"

namespace fluxel {

namespace {

double squared_gap(const TileBounds& a, const TileBounds& b) {
  const glm::vec3 gap = glm::max(glm::vec3(0), glm::max(a.low - b.high, b.low - a.high));
  return static_cast<double>(glm::dot(gap, gap));
}

}  // namespace

TileBounds tile_bounds(std::span<const Element> elements, std::size_t tile, const PowerEstimate& power) {
  TileBounds bounds;
  for (std::size_t k = 0; k < rows_of_tile(tile, elements.size()); ++k) {
    const std::size_t i = tile * kTileSize + k;
    const Element& element = elements[i];
    const auto area = static_cast<double>(element.area);
    bounds.low = glm::min(bounds.low, element.centroid);
    bounds.high = glm::max(bounds.high, element.centroid);
    bounds.area = std::max(bounds.area, area);
    bounds.variance =
        std::max(bounds.variance,
                 static_cast<double>(2 * element.spread + glm::dot(element.elongation, element.elongation)));
    for (std::size_t unknown = i; unknown < power.B.size(); unknown += elements.size()) {
      bounds.power = std::max(bounds.power, area * power.B[unknown]);
      bounds.H = std::min(bounds.H, power.H[unknown]);
    }
  }
  return bounds;
}

bool may_be_near(const TileBounds& a, const TileBounds& b, double error) {
  // As moments_error, with all cosines 1.
  const double r2 = squared_gap(a, b);
  const double variances = a.variance + b.variance;
  return 5 * variances * variances * std::max(a.area, b.area) > std::numbers::pi * r2 * r2 * r2 * error;
}

bool may_be_significant(const TileBounds& a, const TileBounds& b, double share) {
  return std::max(a.power / b.H, b.power / a.H) > std::numbers::pi * squared_gap(a, b) * share;
}

}  // namespace fluxel
