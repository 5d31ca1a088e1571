#pragma once

#include <glm/vec3.hpp>

namespace fluxel {

/// Three linear colour channels. Reflectance is dimensionless, radiosity and exitance are in W/m2 (or lm/m2).
using Rgb = glm::dvec3;

inline constexpr int kChannels = 3;

[[nodiscard]] inline double mean_of_colours(const Rgb& x) { return (x.r + x.g + x.b) / kChannels; }

}  // namespace fluxel
