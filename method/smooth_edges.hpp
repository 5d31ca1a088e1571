#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/edge_pixel.hpp"
#include "hierarchy/irradiance_source.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"
#include "subdivision/camera_raster.hpp"

namespace fluxel {

/// The irradiance [W/m2] of places that no pixel's centre shows, each of which stands for a share of a pixel.
using LightElsewhere =
    std::function<std::vector<Rgb>(std::span<const SeenPlace>, std::span<const double> shares)>;

/// The pixels of a raster, one sample each, in which surfaces meet, by 16 rays, or by 256 at the edge of a
/// lamp: what these see has the `irradiance` [W/m2] of the nearest pixel's centre around that lies on the
/// same surface, or else that of `elsewhere`, which is called once. The ray scene holds the whole scene.
[[nodiscard]] std::vector<EdgePixel> smooth_edges(const Problem& problem, const Raster& raster,
                                                  std::span<const Rgb> irradiance,
                                                  const LightElsewhere& elsewhere);

/// Collective: of a picture that has been gathered, into the solution.
void smooth_gathered_edges(const Problem& problem, IrradianceSource& source, Solution& solution);

/// On the root: of one that shows elements.
void smooth_element_edges(const Problem& problem, Solution& solution);

}  // namespace fluxel
