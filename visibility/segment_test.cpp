#include "visibility/segment_test.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "visibility/cuda/segment.hpp"

namespace fluxel {

namespace {

cuda::Polygon<glm::dvec3> polygon_of(const Patch& patch) {
  return {patch.outline.corner.data(), patch.outline.corners, patch.normal};
}

double squared_diameter(const Outline<glm::dvec3>& outline) {
  double largest = 0;
  for (std::uint32_t a = 0; a < outline.corners; ++a) {
    for (std::uint32_t b = a + 1; b < outline.corners; ++b) {
      const glm::dvec3 separation = outline.corner[b] - outline.corner[a];
      largest = std::max(largest, glm::dot(separation, separation));
    }
  }
  return largest;
}

}  // namespace

bool segment_meets(const Patch& patch, const glm::dvec3& from, const glm::dvec3& to) {
  return cuda::segment_meets(polygon_of(patch), from, to);
}

bool ray_meets(const Patch& patch, const glm::dvec3& from, const glm::dvec3& direction) {
  return cuda::ray_meets(polygon_of(patch), from, direction);
}

double plane_parameter(const Patch& patch, const glm::dvec3& origin, const glm::dvec3& direction) {
  return cuda::plane_parameter(polygon_of(patch), origin, direction);
}

double outline_margin(const Patch& patch, double extent) {
  constexpr double kSliver = 0.02;  // area over the square of the diameter
  const double unit = 0x1p-24 * extent, size = std::sqrt(patch.area);
  const bool sliver = patch.area < kSliver * squared_diameter(patch.outline);
  return std::max(24 * unit,
                  sliver ? std::min(1e-3 * extent, 0.02 * size) : std::min(256 * unit, 0.02 * size));
}

Outline<glm::dvec3> enlarged(const Patch& patch, double extent) {
  const double margin = outline_margin(patch, extent);
  Outline<glm::dvec3> result = patch.outline;
  const std::uint32_t count = patch.outline.corners;
  for (std::uint32_t c = 0; c < count; ++c) {
    const glm::dvec3& corner = patch.outline.corner[c];
    const glm::dvec3 in = glm::normalize(corner - patch.outline.corner[(c + count - 1) % count]);
    const glm::dvec3 out = glm::normalize(patch.outline.corner[(c + 1) % count] - corner);
    const glm::dvec3 off_in = glm::cross(in, patch.normal), off_out = glm::cross(out, patch.normal);
    // Both point along the bisector; one may be zero, where the outline goes straight on or back.
    const glm::dvec3 straight = off_in + off_out, back = in - out;
    const glm::dvec3 bisector =
        glm::normalize(glm::dot(straight, straight) > glm::dot(back, back) ? straight : back);
    const double cosine = glm::dot(bisector, off_in);  // of half the turn
    result.corner[c] = corner + margin / std::max(cosine, 0.125) * bisector;
  }
  return result;
}

}  // namespace fluxel
