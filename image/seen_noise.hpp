#pragma once

#include <optional>
#include <span>

#include "core/raster.hpp"
#include "core/rgb.hpp"

namespace fluxel {

/// The noise of light from pixel to pixel that an eye sees on even surfaces: the standard deviation of a
/// pixel's irradiance, mean of the colours, over the mean around it. From what each pixel differs by from the
/// line between its neighbours, along rows and columns, where all three see one side of one patch and are
/// lit: the median of its size, which edges of shadows hardly change (Donoho & Johnstone 1994, section 4.3).
/// `fine` has `supersample` rows and columns for each of the picture's, `irradiance` an entry for each of its
/// pixels; a pixel of the picture is their mean, where they are all of one side of one patch. None where no
/// three such pixels lie in a line.
[[nodiscard]] std::optional<double> seen_noise(const Raster& fine, int supersample,
                                               std::span<const Rgb> irradiance);

}  // namespace fluxel
