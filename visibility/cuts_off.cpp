#include "visibility/cuts_off.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include "visibility/range_along.hpp"

namespace fluxel {

bool cuts_off(std::span<const glm::dvec3> first, std::span<const glm::dvec3> second, PolygonView polygon,
              double epsilon) {
  const glm::dvec3 area = area_vector(polygon);
  const double length = glm::length(area);
  if (!(length > 0)) return false;
  const glm::dvec3 normal = area / length;

  const double plane = glm::dot(normal, polygon[0]);
  const Range of_first = range_along(normal, first), of_second = range_along(normal, second);
  const bool first_above = of_first.low + of_first.high > of_second.low + of_second.high;
  const Range& above = first_above ? of_first : of_second;
  const Range& below = first_above ? of_second : of_first;
  if (above.low < plane - epsilon || above.high <= plane + epsilon) return false;
  if (below.high > plane + epsilon || below.low >= plane - epsilon) return false;

  // The section of the hull by the plane is the hull of where the segments between corners cross it. Along a
  // segment the distance from an edge is linear, so at the crossing it is a mean of those of the two ends. A
  // segment in the plane needs no care: its ends are crossings of other segments.
  std::array<double, kMaxCutCorners> first_height, second_height, first_depth, second_depth;
  const auto heights = [&](std::span<const glm::dvec3> points, std::array<double, kMaxCutCorners>& height) {
    for (std::size_t k = 0; k < points.size(); ++k) height[k] = std::abs(glm::dot(normal, points[k]) - plane);
  };
  heights(first, first_height);
  heights(second, second_height);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 edge = polygon[i + 1 < polygon.size() ? i + 1 : 0] - polygon[i];
    const glm::dvec3 inward = glm::cross(normal, edge);
    const double least = -epsilon * glm::length(edge);
    for (std::size_t k = 0; k < first.size(); ++k) first_depth[k] = glm::dot(inward, first[k] - polygon[i]);
    for (std::size_t k = 0; k < second.size(); ++k)
      second_depth[k] = glm::dot(inward, second[k] - polygon[i]);
    for (std::size_t a = 0; a < first.size(); ++a) {
      for (std::size_t b = 0; b < second.size(); ++b) {
        const double crossing = first_depth[a] * second_height[b] + second_depth[b] * first_height[a];
        if (crossing < least * (first_height[a] + second_height[b])) return false;
      }
    }
  }
  return true;
}

}  // namespace fluxel
