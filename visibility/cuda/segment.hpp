#pragma once

#include <cstring>

#include "visibility/cuda/portable.hpp"

namespace fluxel::cuda {

// The tests behind visibility/segment_test, for vectors of the host's library and for the device's own.

/// A patch as an obstacle: a convex polygon, counter-clockwise seen from where its normal points.
template <class Vec>
struct Polygon {
  const Vec* corner;
  std::uint32_t corners;
  Vec normal;
};

FLUXEL_PORTABLE inline std::uint64_t bits_of(double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// The vector in a unit of length, a power of two, that makes its largest coordinate about 1.
template <class Vec>
FLUXEL_PORTABLE inline Vec without_scale(const Vec& v) {
  const double largest = greater(greater(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
  return (largest > 0 ? ldexp(1.0, -ilogb(largest)) : 1.0) * v;
}

/// Spreads what differs in `key` over all bits (Stafford's variant 13 of the finaliser of MurmurHash3, as in
/// Steele, Lea & Flood, Fast splittable pseudorandom number generators, 2014).
FLUXEL_PORTABLE inline std::uint64_t mixed(std::uint64_t key) {
  key = (key ^ key >> 30) * 0xBF58476D1CE4E5B9u;
  key = (key ^ key >> 27) * 0x94D049BB133111EBu;
  return key ^ key >> 31;
}

/// A direction by chance, the same for the same line, and in a scene scaled by a power of two.
template <class Vec>
FLUXEL_PORTABLE inline Vec direction_of_chance(const Vec& from, const Vec& along) {
  const Vec a = without_scale(from), b = without_scale(along);
  const double line[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
  std::uint64_t key = 0;
  for (const double coordinate : line)
    key = mixed(key + 0x9E3779B97F4A7C15u + bits_of(coordinate + 0.0));  // -0 becomes 0
  const double unit = 1.0 / (1 << 20);
  return {static_cast<double>(key & 0x1FFFFF) * unit - 1,
          static_cast<double>(key >> 21 & 0x1FFFFF) * unit - 1,
          static_cast<double>(key >> 42 & 0x1FFFFF) * unit - 1};
}

/// Whether a line passes all edges on the inner side: volumes over it and an edge are positive inside for a
/// line that comes from above. A line through an edge is moved by next to nothing, in a direction by chance:
/// it meets one of two patches that share the edge, and on a lattice not all rays fall on one side.
template <class Vec>
FLUXEL_PORTABLE inline bool passes_inside(const Polygon<Vec>& polygon, const Vec& from, const Vec& along,
                                          bool from_above) {
  const double sign = from_above ? 1 : -1;
  Vec last = polygon.corner[polygon.corners - 1] - from;
  for (std::uint32_t c = 0; c < polygon.corners; ++c) {
    const Vec next = polygon.corner[c] - from;
    double volume = dot(cross(next, last), along);
    if (volume == 0) volume = dot(cross(direction_of_chance(from, along), next - last), along);
    if (sign * volume < 0) return false;
    last = next;
  }
  return true;
}

template <class Vec>
FLUXEL_PORTABLE inline bool is_above(const Polygon<Vec>& polygon, const Vec& point) {
  return dot(polygon.normal, point - polygon.corner[0]) > 0;
}

/// See visibility/segment_test, which is this.
template <class Vec>
FLUXEL_PORTABLE inline bool segment_meets(const Polygon<Vec>& polygon, const Vec& from, const Vec& to) {
  const bool from_above = is_above(polygon, from);
  return from_above != is_above(polygon, to) && passes_inside(polygon, from, to - from, from_above);
}

template <class Vec>
FLUXEL_PORTABLE inline bool ray_meets(const Polygon<Vec>& polygon, const Vec& from, const Vec& direction) {
  const bool from_above = is_above(polygon, from);
  const bool downwards = dot(polygon.normal, direction) < 0;
  return from_above == downwards && passes_inside(polygon, from, direction, from_above);
}

}  // namespace fluxel::cuda
