#pragma once

#include <cmath>

#include "reference/cuda/path_scene.hpp"

namespace fluxel::cuda {

/// Sines and cosines of a device err by up to two units in the last place (CUDA C++ Programming Guide,
/// mathematical functions), those of a host by one. That turns a ray by less than 1e-15, and what its path
/// finds changes by less than this part, but where the ray meets a surface at a cosine below 1e-6 or passes
/// an edge on its other side.
inline constexpr double kTurned = 1e-9;

/// Of paths on a device, those that may differ by more. A ray in a million meets
/// a surface so flatly, and a path has some ten of them at most; patches at one place and rays that lie in a
/// patch's plane, of which Embree and the device may choose differently, add to that.
inline constexpr double kMostDifferingPaths = 1e-3;

/// Whether two irradiances of one path are the same but for that.
inline bool is_same_path(const Double3& a, const Double3& b) {
  const auto is_near = [](double x, double y) {
    return std::fabs(x - y) <= kTurned * greater(std::fabs(x), std::fabs(y));
  };
  return is_near(a.x, b.x) && is_near(a.y, b.y) && is_near(a.z, b.z);
}

}  // namespace fluxel::cuda
