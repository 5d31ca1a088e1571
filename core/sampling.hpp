#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "core/element.hpp"

namespace fluxel {

/// Bits that look random, of a seed (SplitMix64: Steele, Lea & Flood 2014).
[[nodiscard]] std::uint64_t random_bits(std::uint64_t seed);

/// A point of a triangle or parallelogram, area-preserving from the unit square.
template <class Vec>
[[nodiscard]] glm::dvec3 surface_point(const Outline<Vec>& outline, double u, double v) {
  const glm::dvec3 corner(outline.corner[0]);
  const glm::dvec3 first = glm::dvec3(outline.corner[1]) - corner;
  if (outline.corners == 4) return corner + u * first + v * (glm::dvec3(outline.corner[3]) - corner);
  const double root = std::sqrt(u);
  return corner + root * (1 - v) * first + root * v * (glm::dvec3(outline.corner[2]) - corner);
}

/// A direction of the hemisphere around a unit normal, with a density of cosine over pi in u and v of the
/// unit square (Malley's method: a disc's points lifted to the hemisphere; concentric map of Shirley & Chiu
/// 1997).
[[nodiscard]] glm::dvec3 cosine_direction(double u, double v, const glm::dvec3& normal);

}  // namespace fluxel
