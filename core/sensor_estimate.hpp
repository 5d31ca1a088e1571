#pragma once

#include "core/rgb.hpp"

namespace fluxel {

/// Independent randomisations of an estimate: their means' spread gives the standard error, by Student's t
/// of 15 degrees of freedom.
inline constexpr int kRandomisations = 16;

/// What has been measured of a sensor, in the sensor's unit.
struct SensorEstimate {
  Rgb mean{0};
  Rgb error{0};   ///< standard error of the mean
  Rgb half_a{0};  ///< mean of one half of the samples,
  Rgb half_b{0};  ///< and of the other, independent of it
};

}  // namespace fluxel
