#pragma once

#include <cstring>

#include "visibility/cuda/portable.hpp"

namespace fluxel::cuda {

// The tests behind visibility/segment_test, for vectors of the host's library and for the device's own.

/// A patch as an occluder: a convex polygon, counter-clockwise seen from where its normal points.
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

/// Bits by chance, the same for the same line, and in a scene scaled by a power of two.
template <class Vec>
FLUXEL_PORTABLE inline std::uint64_t chance_of(const Vec& from, const Vec& along) {
  const Vec a = without_scale(from), b = without_scale(along);
  const double line[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
  std::uint64_t key = 0;
  for (const double coordinate : line)
    key = mixed(key + 0x9E3779B97F4A7C15u + bits_of(coordinate + 0.0));  // -0 becomes 0
  return key;
}

/// Where a corner is seen along a line, which is at the origin.
struct Place {
  double u, v;
};

/// In the plane across an axis, sheared so that the line stands on it (Woop, Benthin & Wald, Watertight
/// ray/triangle intersection, 2013). It depends on the corner and the line alone, so that all patches around
/// a corner have it at one place, however it is rounded. These are the sheared coordinates times the line's
/// length along the axis, or moments about the line: without a division nothing is rounded where coordinates
/// have few digits.
template <int kAxis, class Vec>
FLUXEL_PORTABLE inline Place place_of(const Vec& corner, const Vec& from, const Vec& along) {
  const Vec moment = cross(corner - from, along);
  return kAxis == 0   ? Place{moment.y, moment.z}
         : kAxis == 1 ? Place{moment.z, moment.x}
                      : Place{moment.x, moment.y};
}

/// The sign of a.u b.v - a.v b.u, exactly: which way one turns around the origin from a to b. Rounding keeps
/// the order of two products; where it makes them equal, what it took from each is compared.
FLUXEL_PORTABLE inline int turn(const Place& a, const Place& b) {
  const double left = a.u * b.v, right = a.v * b.u;
  if (left != right) return left > right ? 1 : -1;
  const double left_rest = std::fma(a.u, b.v, -left), right_rest = std::fma(a.v, b.u, -right);
  return left_rest > right_rest ? 1 : left_rest < right_rest ? -1 : 0;
}

/// The same from a to b through the origin, once that is moved by next to nothing along u and by next to
/// nothing of that along v, forwards or back by a bit of chance each: 0 only where a is b.
FLUXEL_PORTABLE inline int turn_by_chance(const Place& a, const Place& b, std::uint64_t chance) {
  const int along_u = (chance & 1) != 0 ? 1 : -1, along_v = (chance & 2) != 0 ? 1 : -1;
  if (a.v != b.v) return a.v > b.v ? along_u : -along_u;
  return a.u < b.u ? along_v : a.u > b.u ? -along_v : 0;
}

template <int kAxis, class Vec>
FLUXEL_PORTABLE inline bool passes_inside(const Polygon<Vec>& polygon, const Vec& from, const Vec& along) {
  int side = 0;
  Place last = place_of<kAxis>(polygon.corner[polygon.corners - 1], from, along);
  for (std::uint32_t c = 0; c < polygon.corners; ++c) {
    const Place next = place_of<kAxis>(polygon.corner[c], from, along);
    int of_edge = turn(last, next);
    if (of_edge == 0) of_edge = turn_by_chance(last, next, chance_of(from, along));
    if (of_edge * side < 0) return false;
    if (of_edge != 0) side = of_edge;
    last = next;
  }
  return side != 0;
}

/// Whether a line passes all edges on one side. Of patches around an edge or a corner that it passes through,
/// chance has it meet those that it would meet beside it, so that on a lattice not all rays fall on one side.
template <class Vec>
FLUXEL_PORTABLE inline bool passes_inside(const Polygon<Vec>& polygon, const Vec& from, const Vec& along) {
  // The longest axis: across a short one the shear, and with it all rounding, would be large.
  const double x = std::fabs(along.x), y = std::fabs(along.y), z = std::fabs(along.z);
  if (z >= x && z >= y) return passes_inside<2>(polygon, from, along);
  return x >= y ? passes_inside<0>(polygon, from, along) : passes_inside<1>(polygon, from, along);
}

template <class Vec>
FLUXEL_PORTABLE inline bool is_above(const Polygon<Vec>& polygon, const Vec& point) {
  return dot(polygon.normal, point - polygon.corner[0]) > 0;
}

/// See visibility/segment_test, which is this.
template <class Vec>
FLUXEL_PORTABLE inline bool segment_meets(const Polygon<Vec>& polygon, const Vec& from, const Vec& to) {
  const bool from_above = is_above(polygon, from);
  return from_above != is_above(polygon, to) && passes_inside(polygon, from, to - from);
}

/// Where a line meets the patch's plane, by its parameter.
template <class Vec>
FLUXEL_PORTABLE inline double plane_parameter(const Polygon<Vec>& polygon, const Vec& origin,
                                              const Vec& direction) {
  return dot(polygon.normal, polygon.corner[0] - origin) / dot(polygon.normal, direction);
}

template <class Vec>
FLUXEL_PORTABLE inline bool ray_meets(const Polygon<Vec>& polygon, const Vec& from, const Vec& direction) {
  const bool from_above = is_above(polygon, from);
  const bool downwards = dot(polygon.normal, direction) < 0;
  return from_above == downwards && passes_inside(polygon, from, direction);
}

}  // namespace fluxel::cuda
