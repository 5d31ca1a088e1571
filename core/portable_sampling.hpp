#pragma once

// Portable: what a device compiles too (see visibility/cuda/portable.hpp). For vectors of the host's library
// and for the device's own.

#include <cmath>
#include <cstdint>

#include "core/portable.hpp"

namespace fluxel {

/// Bits that look random, of a seed (SplitMix64: Steele, Lea & Flood 2014).
[[nodiscard]] FLUXEL_PORTABLE inline std::uint64_t random_bits(std::uint64_t seed) {
  seed += 0x9E3779B97F4A7C15u;
  seed = (seed ^ (seed >> 30)) * 0xBF58476D1CE4E5B9u;
  seed = (seed ^ (seed >> 27)) * 0x94D049BB133111EBu;
  return seed ^ (seed >> 31);
}

/// A number of [0, 1] as one of [0, 1).
[[nodiscard]] FLUXEL_PORTABLE inline double below_one(double number) {
  constexpr double kBelowOne = 1 - 0x1p-53;
  return number < kBelowOne ? number : kBelowOne;
}

/// A point of a triangle or parallelogram with so many corners, area-preserving from the unit square.
template <class Vec>
[[nodiscard]] FLUXEL_PORTABLE inline Vec surface_point(const Vec* corner, std::uint32_t corners, double u,
                                                       double v) {
  const Vec first = corner[1] - corner[0];
  if (corners == 4) return corner[0] + u * first + v * (corner[3] - corner[0]);
  const double root = std::sqrt(u);
  return corner[0] + root * (1 - v) * first + root * v * (corner[2] - corner[0]);
}

/// A direction of the hemisphere around a unit normal, with a density of cosine over pi in u and v of the
/// unit square (Malley's method: a disc's points lifted to the hemisphere; concentric map of Shirley & Chiu
/// 1997).
template <class Vec>
[[nodiscard]] FLUXEL_PORTABLE inline Vec cosine_direction(double u, double v, const Vec& normal) {
  constexpr double kPi = 3.14159265358979323846;
  const double a = 2 * u - 1;
  const double b = 2 * v - 1;
  double radius = a, angle = 0;
  if (std::fabs(a) > std::fabs(b)) {
    angle = kPi / 4 * (b / a);
  } else if (b != 0) {
    radius = b;
    angle = kPi / 2 - kPi / 4 * (a / b);
  }
  const Vec least = std::fabs(normal.x) < 0.5 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  const Vec tangent = normalize(cross(normal, least));
  const Vec bitangent = cross(normal, tangent);
  const double height = std::sqrt(std::fmax(0.0, 1 - radius * radius));
  return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent + height * normal;
}

}  // namespace fluxel
