#pragma once

#include "visibility/cuda/portable.hpp"

namespace fluxel::cuda {

/// A ray; the direction need not be normalised, and its length is from 1e-18 to 1e18.
struct Ray {
  Double3 origin, direction;
};

/// Where a ray from outside the ball of this radius around the origin enters it, by its parameter; infinity
/// where it passes by.
template <class Vec>
FLUXEL_PORTABLE inline double entry_from_outside(const Vec& origin, const Vec& direction, double radius) {
  const double closest = -dot(origin, direction) / dot(direction, direction);
  const Vec at = origin + closest * direction;
  const double square = radius * radius - dot(at, at);
  if (square < 0 || closest < 0) return INFINITY;
  return closest - std::sqrt(square) / length(direction);
}

/// How far along a ray from outside the scene begins, by its parameter: where it enters the ball with twice
/// the scene's extent, which holds all patches. 0 for a ray from within, as most are; infinity where a ray
/// passes the ball by. In double precision, so that a far origin costs no digits, but of the extent that
/// devices know, so that all enter at the same place.
template <class Vec>
FLUXEL_PORTABLE inline double entry_of_ray(const Vec& origin, const Vec& direction, float extent) {
  const double radius = 2 * static_cast<double>(extent);
  if (dot(origin, origin) <= radius * radius) return 0;
  return entry_from_outside(origin, direction, radius);
}

}  // namespace fluxel::cuda
