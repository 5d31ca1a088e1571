#pragma once

#include "image/picture.hpp"

namespace fluxel {

/// Takes single bright or dark pixels out of the picture's radiance, the other layers stay as they are: the
/// median of each channel over the square of 2 `radius` + 1 pixels a side. Outside the picture the nearest
/// pixel is repeated. A radius of 0 leaves the picture as it is. Expects a radius of 0 or more [pixels].
void apply_median(int radius, Picture& picture);

}  // namespace fluxel
