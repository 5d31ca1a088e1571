#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/edge_pixel.hpp"
#include "core/element.hpp"
#include "core/raster.hpp"
#include "core/rgb.hpp"
#include "core/surface_light.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// What the camera sees, in layers. Row-major, row 0 at the top; all vectors have width * height entries.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<Rgb> radiance;       ///< B/pi of the side that is seen [W/m2/sr]; black where nothing is
  std::vector<ElementId> element;  ///< kNoElement where nothing is seen
  std::vector<float> depth;        ///< along the view axis [m]; infinity where nothing is seen
  std::vector<glm::vec3> normal;   ///< unit, of the side that is seen; 0 where nothing is
  std::vector<Rgb> reflectance;    ///< 0..1
  std::vector<Rgb> irradiance;     ///< [W/m2]

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Shades a raster that has `supersample` rows and columns for each of the picture's: constant radiosity over
/// an element. Radiance, reflectance and irradiance are the means over a pixel's sub-pixels, the background
/// counting as black; element, depth and normal are those of the sub-pixel at the pixel's centre, for an even
/// `supersample` of the lower right of the four that touch it. A side that is no unknown (the back of a
/// one-sided element) is black: reflectance, irradiance and radiance 0. `irradiance` [W/m2], where there is
/// any, has an entry a sub-pixel and takes the place of its element's; and `edges` take the place of the
/// means of their pixels. Throws std::logic_error where the sizes do not fit each other.
[[nodiscard]] Picture make_picture(const Raster& fine, int supersample, const Scene& scene,
                                   const ElementView& mesh, const SurfaceLight& light,
                                   std::span<const Rgb> irradiance = {},
                                   std::span<const EdgePixel> edges = {});

}  // namespace fluxel
