#include "visibility/segment_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "core/hash.hpp"

namespace fluxel {

namespace {

/// The vector in a unit of length, a power of two, that makes its largest coordinate about 1.
glm::dvec3 without_scale(const glm::dvec3& x) {
  const double largest = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
  return (largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0) * x;
}

/// A direction by chance, the same for the same line, and in a scene scaled by a power of two.
glm::dvec3 direction_of_chance(const glm::dvec3& from, const glm::dvec3& along) {
  const std::array<glm::dvec3, 2> line{without_scale(from) + 0.0,
                                       without_scale(along) + 0.0};  // -0 becomes 0
  const std::uint64_t hash = hash_bytes(std::as_bytes(std::span(line)));
  const auto part = [hash](int shift) { return static_cast<double>(hash >> shift & 0x1FFFFF) * 0x1p-20 - 1; };
  return {part(0), part(21), part(42)};
}

/// Whether a line passes all edges on the inner side: volumes over it and an edge are positive inside for a
/// line that comes from above. A line through an edge is moved by next to nothing, in a direction by chance:
/// it meets one of two patches that share the edge, and on a lattice not all rays fall on one side.
bool passes_inside(const Outline<glm::dvec3>& outline, const glm::dvec3& from, const glm::dvec3& along,
                   bool from_above) {
  const double sign = from_above ? 1 : -1;
  glm::dvec3 last = outline.corner[outline.corners - 1] - from;
  for (std::uint32_t c = 0; c < outline.corners; ++c) {
    const glm::dvec3 next = outline.corner[c] - from;
    double volume = glm::dot(glm::cross(next, last), along);
    if (volume == 0) volume = glm::dot(glm::cross(direction_of_chance(from, along), next - last), along);
    if (sign * volume < 0) return false;
    last = next;
  }
  return true;
}

bool is_above(const Patch& patch, const glm::dvec3& point) {
  return glm::dot(patch.normal, point - patch.outline.corner[0]) > 0;
}

}  // namespace

bool segment_meets(const Patch& patch, const glm::dvec3& from, const glm::dvec3& to) {
  const bool from_above = is_above(patch, from);
  return from_above != is_above(patch, to) && passes_inside(patch.outline, from, to - from, from_above);
}

bool ray_meets(const Patch& patch, const glm::dvec3& from, const glm::dvec3& direction) {
  const bool from_above = is_above(patch, from);
  const bool downwards = glm::dot(patch.normal, direction) < 0;
  return from_above == downwards && passes_inside(patch.outline, from, direction, from_above);
}

Outline<glm::dvec3> enlarged(const Patch& patch, double extent) {
  const double margin =
      std::max(24 * 0x1p-24 * extent, std::min(1e-3 * extent, 0.02 * std::sqrt(patch.area)));
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
