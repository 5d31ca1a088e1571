#pragma once

#include "visibility/cuda/portable.hpp"

namespace fluxel::cuda {

// The rules of LightPaths, for vectors of the host's library and for the device's own.

/// Where nothing is absorbed and nothing escapes no path would end.
inline constexpr double kMaxSurvival = 0.999;

inline constexpr double kPi = 3.14159265358979323846;

/// cos cos / (pi r^2) [1/m2] between a point and one of an emitter; not positive where one turns away from
/// the other.
template <class Vec>
FLUXEL_PORTABLE inline double kernel_between(const Vec& at, const Vec& normal, const Vec& emitter,
                                             const Vec& emitter_normal) {
  const Vec way = emitter - at;
  const double squared = dot(way, way);
  const double out = -dot(emitter_normal, way), in = dot(normal, way);
  return out > 0 && in > 0 ? in * out / (kPi * squared * squared) : 0;
}

/// The same between a point and the one that a ray in a unit direction has met.
template <class Vec>
FLUXEL_PORTABLE inline double kernel_along(const Vec& at, const Vec& normal, const Vec& direction,
                                           const Vec& met, const Vec& met_normal) {
  const Vec way = met - at;
  return std::fabs(dot(normal, direction) * dot(met_normal, direction)) / (kPi * dot(way, way));
}

/// What the exitance of an emitter's drawn point is multiplied with. With p the density of the drawn point
/// and q that with which the path's next ray meets it, mostly K = cos cos / (pi r^2) of a cosine-distributed
/// one, a drawn point's E K / p times its weight p^2 / (p^2 + q^2) has a bound: E / 2 where q = K.
FLUXEL_PORTABLE inline double share_of_drawn(double kernel, double next, double drawn) {
  return kernel * drawn / (next * next + drawn * drawn);
}

/// And that of the emitter which the path's next ray meets.
FLUXEL_PORTABLE inline double share_of_met(double next, double drawn) {
  return next * next / (next * next + drawn * drawn);
}

}  // namespace fluxel::cuda
