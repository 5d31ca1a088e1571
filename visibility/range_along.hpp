#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>

namespace fluxel {

/// From the least to the largest of some numbers.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
};

/// Of dot(direction, x) over the points.
[[nodiscard]] inline Range range_along(const glm::dvec3& direction, std::span<const glm::dvec3> points) {
  Range range;
  for (const glm::dvec3& x : points) {
    const double at = glm::dot(direction, x);
    range.low = std::min(range.low, at);
    range.high = std::max(range.high, at);
  }
  return range;
}

}  // namespace fluxel
