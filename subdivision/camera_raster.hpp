#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "core/camera.hpp"
#include "core/raster.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Depths of hits that differ by less than this [m] are equal: one millionth of the distance scale, which a
/// camera outside the scene does not raise above three extents of the scene.
[[nodiscard]] double depth_tolerance(const Scene& scene, const Camera& camera);

/// Depth of the nearest hit of every pixel's ray, infinity where there is none. The ray scene may hold a part
/// of the patches only: the rasters of all parts are merged by the least depth, and the result is that of the
/// whole to the last bit. Row-major.
[[nodiscard]] std::vector<double> nearest_depths(const RayScene& part, const Scene& scene,
                                                 const Camera& camera, int supersample, int threads);

/// Of equal depths at a pixel, the claim with the lowest number wins: in one-sided scenes a front before a
/// back, then the emitter, then the lower patch number.
using PixelClaim = std::uint64_t;
inline constexpr PixelClaim kNoClaim = ~PixelClaim{0};

/// The best claim among the patches of the part whose depth is within tolerance of `nearest`, the merged
/// depth.
[[nodiscard]] std::vector<PixelClaim> claim_pixels(const RayScene& part, const Scene& scene,
                                                   const Camera& camera, int supersample,
                                                   const std::vector<double>& nearest, int threads);

/// The merged raster, without elements; depths are those of the winners' planes, in double precision.
[[nodiscard]] Raster make_raster(const Scene& scene, const Camera& camera, int supersample,
                                 const std::vector<PixelClaim>& claims);

/// What a ray through the picture sees.
struct SeenPlace {
  PatchId patch = kNoPatch;  ///< none: nothing
  bool front = false;
  double depth = std::numeric_limits<double>::infinity();  ///< along the view axis [m]
  glm::dvec3 point{0};                                     ///< [m, recentred]
};

/// What the rays through these places of the picture [pixels, from its upper left corner] see of the whole
/// scene, as those through the pixels' centres do.
[[nodiscard]] std::vector<SeenPlace> see(const RayScene& whole, const Scene& scene, const Camera& camera,
                                         std::span<const glm::dvec2> places, int threads);

/// Where the pixel's ray meets the plane of the patch that it sees [m, recentred].
[[nodiscard]] glm::dvec3 pixel_point(const Scene& scene, const Camera& camera, const PixelRays& rays,
                                     const Raster& raster, std::size_t pixel);

/// Least distance [m] of two hit points of different pixels on one surface whose depth is at least `depth`.
/// For directions d1 and d2 = d1 + e with a component of 1 along the axis and e across it, a point at depth t
/// on the first line is t |d1 x e| / |d2| >= t |e| / |d2| from the second.
[[nodiscard]] double least_pixel_spacing(const Camera& camera, int supersample, double depth);

/// Throws InputError where the camera sees nothing, or only sides that are no unknowns (the backs of
/// one-sided patches, or sides sealed in closed bodies).
void require_view(const Scene& scene, const Raster& raster);

}  // namespace fluxel
