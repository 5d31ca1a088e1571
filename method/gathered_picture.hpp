#pragma once

#include "method/picture_light.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Whether pixels have light of their own, not that of elements.
[[nodiscard]] bool gathers_picture(const Options& options);

/// Collective: the light of each of the raster's pixels from a finished solution, off by at most `allowed`
/// (see PictureGoal) by how it is gathered, into the solution.
void gather_picture(const Problem& problem, IrradianceSource& source, double allowed, Solution& solution);

/// What was gathered of each pixel, into the solution.
void take_picture(PictureLight light, Solution& solution);

}  // namespace fluxel
