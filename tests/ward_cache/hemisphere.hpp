#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>

#include "core/rgb.hpp"
#include "final_gather/side_point.hpp"

namespace fluxel::ward_cache {

/// What is seen along a ray.
struct Sight {
  double distance = 0;  ///< [m]; infinity where the ray leaves the scene
  Rgb radiosity{0};     ///< of the light that is looked for [W/m2]
};

/// Along a unit direction, from a place that is known.
using Look = std::function<Sight(const glm::dvec3& direction)>;

/// A quantity by colour and direction in space.
using Gradient = std::array<glm::dvec3, kChannels>;

/// Rays over the hemisphere: strata of the angle to the normal and of that around it.
struct Strata {
  int rings = 24, sectors = 76;  ///< about pi sectors a ring (Ward & Heckbert 1992)
};

/// What a place sees around it.
struct HemisphereLight {
  Rgb irradiance{0};         ///< [W/m2]
  Gradient rotation{};       ///< change of irradiance by turning about an axis [W/m2 a radian]
  Gradient translation{};    ///< likewise by moving along a direction of the plane [W/m3]
  double mean_distance = 0;  ///< harmonic [m]; infinity where nothing is seen
};

/// Irradiance, gradients and distances by one ray through the middle of each stratum: equal parts of the
/// projected solid angle (Ward, Rubinstein & Clear 1988; gradients: Ward & Heckbert 1992, derived anew in the
/// .cpp). What lies between two strata is taken to be an edge at the nearer of both.
[[nodiscard]] HemisphereLight look_around(const glm::dvec3& normal, const Strata& strata, const Look& look);

}  // namespace fluxel::ward_cache
