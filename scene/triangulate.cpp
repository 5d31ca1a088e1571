#include "scene/triangulate.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>

namespace fluxel {
namespace {

/// Twice the signed area of a triangle in the plane, positive counter-clockwise.
double double_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners in the plane that is seen along `normal`, counter-clockwise where the polygon is by the right
/// hand.
std::vector<glm::dvec2> project(std::span<const glm::dvec3> corners, const glm::dvec3& normal) {
  const glm::dvec3 n = glm::normalize(normal);
  const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 1, 0};
  const glm::dvec3 u = glm::normalize(glm::cross(axis, n));
  const glm::dvec3 v = glm::cross(n, u);
  std::vector<glm::dvec2> points;
  points.reserve(corners.size());
  for (const glm::dvec3& corner : corners) {
    const glm::dvec3 from_first = corner - corners.front();
    points.emplace_back(glm::dot(from_first, u), glm::dot(from_first, v));
  }
  return points;
}

/// The corners that are left, in order, and their places in the plane.
struct Ring {
  std::vector<glm::dvec2> points;
  std::vector<std::size_t> left;
  double least_area = 0;  ///< twice the area below which a triangle has none

  [[nodiscard]] CornerTriple around(std::size_t i) const {
    const std::size_t n = left.size();
    return {left[(i + n - 1) % n], left[i], left[(i + 1) % n]};
  }

  [[nodiscard]] double double_area_at(std::size_t i) const {
    const auto [a, b, c] = around(i);
    return double_area(points[a], points[b], points[c]);
  }

  /// Whether no other corner lies in the triangle at i. Corners that coincide with one of the triangle's do
  /// not count: outlines with a hole pass twice through the ends of the cut that leads to it.
  [[nodiscard]] bool is_ear(std::size_t i) const {
    if (double_area_at(i) <= least_area) return false;
    const auto [a, b, c] = around(i);
    return std::none_of(left.begin(), left.end(), [&, a = a, b = b, c = c](std::size_t other) {
      const glm::dvec2& p = points[other];
      if (p == points[a] || p == points[b] || p == points[c]) return false;
      return double_area(points[a], points[b], p) >= 0 && double_area(points[b], points[c], p) >= 0 &&
             double_area(points[c], points[a], p) >= 0;
    });
  }
};

}  // namespace

glm::dvec3 vector_area(std::span<const glm::dvec3> corners) {
  glm::dvec3 sum{0};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return 0.5 * sum;
}

Triangulation triangulate(std::span<const glm::dvec3> corners) {
  const glm::dvec3 area = vector_area(corners);
  Ring ring{.points = project(corners, area), .left = std::vector<std::size_t>(corners.size())};
  std::iota(ring.left.begin(), ring.left.end(), std::size_t{0});
  constexpr double kRoundOff = 1e-14;
  ring.least_area = kRoundOff * glm::length(area);

  Triangulation result;
  std::size_t i = 1;
  while (ring.left.size() >= 3) {
    const std::size_t n = ring.left.size();
    std::size_t tried = 0;
    while (tried < n && !ring.is_ear(i % n)) {
      ++i;
      ++tried;
    }
    if (tried == n) {  // no ear: what is left has no area, or crosses itself
      i = 0;
      while (i < n && ring.double_area_at(i) <= ring.least_area) ++i;
      if (i == n) {
        for (std::size_t k = 0; k < n; ++k) result.simple &= ring.double_area_at(k) >= -ring.least_area;
        return result;
      }
      result.simple = false;
    }
    i %= n;
    result.triangles.push_back(ring.around(i));
    ring.left.erase(ring.left.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return result;
}

}  // namespace fluxel
