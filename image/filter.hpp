#pragma once

#include "core/options.hpp"
#include "image/picture.hpp"

namespace fluxel {

/// Filters the radiance of the picture; the other layers stay as they are.
/// Gaussian: standard deviation `size` pixels, cut at 3 of them; the weights inside the picture sum to 1, so
/// that the borders do not darken. Median: of each channel over the square of 2 `size` + 1 pixels a side;
/// outside the picture the nearest pixel is repeated. A size of 0 leaves the picture as it is. Throws
/// InputError where the size is negative or not finite, or a median's radius no whole number.
void apply_filter(const PictureFilter& filter, Picture& picture);

}  // namespace fluxel
