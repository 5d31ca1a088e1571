#pragma once

#include <vector>

#include "core/rgb.hpp"

namespace fluxel {

/// The light that leaves and reaches the elements, one entry for each in their order [W/m2] (or [lm/m2]).
/// The back vectors are empty where no element has a back unknown.
struct SurfaceLight {
  std::vector<Rgb> B_front;  ///< radiosity
  std::vector<Rgb> B_back;
  std::vector<Rgb> H_front;  ///< irradiance
  std::vector<Rgb> H_back;
};

}  // namespace fluxel
