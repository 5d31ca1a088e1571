#include "subdivision/camera_raster.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/error.hpp"

namespace fluxel {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kBackBit =
    34;  // above the bits of what covers an emitter, and of emitters, above 32 of the number
constexpr int kBareBit = 33;
constexpr int kDarkBit = 32;

PixelClaim make_claim(const Scene& scene, PatchId id, const glm::dvec3& direction) {
  const Patch& patch = scene.patch(id);
  const bool back = glm::dot(patch.normal, direction) > 0;
  const bool one_sided = scene.material(patch).sides == Sides::one;
  return (PixelClaim{back && one_sided} << kBackBit) | (PixelClaim{!patch.covers_emitter} << kBareBit) |
         (PixelClaim{!scene.emits(id)} << kDarkBit) | static_cast<PixelClaim>(index(id));
}

/// Calls `work(pixel, direction)` for every pixel of the fine raster.
template <class Work>
void for_each_pixel(const PixelRays& rays, int threads, const Work& work) {
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(0, rays.height(), [&](int row) {
      for (int column = 0; column < rays.width(); ++column) {
        const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(rays.width()) +
                           static_cast<std::size_t>(column);
        work(pixel, rays.direction(column, row));
      }
    });
  });
}

std::size_t pixel_count(const PixelRays& rays) {
  return static_cast<std::size_t>(rays.width()) * static_cast<std::size_t>(rays.height());
}

/// Depth of the nearest hit; infinity where there is none.
double nearest_depth(const RayScene& part, const glm::dvec3& eye, const glm::dvec3& direction,
                     double tolerance) {
  const PatchHit first = part.first_hit(eye, direction);
  if (first.patch == kNoPatch) return kInfinity;
  // Of nearly coincident patches single precision may name any: the least depth of them all does not
  // depend on which of them are in this part.
  thread_local std::vector<PatchHit> hits;
  hits.clear();
  part.all_hits(eye, direction, first.t + tolerance, hits);
  double depth = first.t;
  for (const PatchHit& hit : hits) depth = std::min(depth, hit.t);
  return depth;
}

PixelClaim best_claim(const RayScene& part, const Scene& scene, const glm::dvec3& eye,
                      const glm::dvec3& direction, double nearest, double tolerance) {
  if (!std::isfinite(nearest)) return kNoClaim;
  const double limit = nearest + tolerance;
  thread_local std::vector<PatchHit> hits;
  hits.clear();
  // Single precision may put a hit of the limit's depth a little behind it.
  part.all_hits(eye, direction, limit + tolerance, hits);
  PixelClaim best = kNoClaim;
  for (const PatchHit& hit : hits)
    if (hit.t <= limit) best = std::min(best, make_claim(scene, hit.patch, direction));
  return best;
}

SeenPlace place_of(const Scene& scene, const glm::dvec3& eye, const glm::dvec3& direction, PixelClaim claim) {
  if (claim == kNoClaim) return {};
  const PatchId id{static_cast<std::uint32_t>(claim)};
  const Patch& patch = scene.patch(id);
  const double along = glm::dot(patch.normal, direction);
  const double depth = glm::dot(patch.normal, patch.outline.corner[0] - eye) / along;
  return {id, along < 0, depth, eye + depth * direction};
}

}  // namespace

double depth_tolerance(const Scene& scene, const Camera& camera) {
  // From further away rays begin near the scene, and depths are in double precision.
  return 1e-6 * (scene.extent + std::min(glm::length(camera.eye - scene.origin), 2 * scene.extent));
}

std::vector<double> nearest_depths(const RayScene& part, const Scene& scene, const Camera& camera,
                                   int supersample, int threads) {
  const PixelRays rays(camera, supersample);
  const glm::dvec3 eye = camera.eye - scene.origin;
  const double tolerance = depth_tolerance(scene, camera);
  std::vector<double> depth(pixel_count(rays), kInfinity);
  for_each_pixel(rays, threads, [&](std::size_t pixel, const glm::dvec3& direction) {
    depth[pixel] = nearest_depth(part, eye, direction, tolerance);
  });
  return depth;
}

std::vector<PixelClaim> claim_pixels(const RayScene& part, const Scene& scene, const Camera& camera,
                                     int supersample, const std::vector<double>& nearest, int threads) {
  const PixelRays rays(camera, supersample);
  const glm::dvec3 eye = camera.eye - scene.origin;
  const double tolerance = depth_tolerance(scene, camera);
  std::vector<PixelClaim> claims(pixel_count(rays), kNoClaim);
  for_each_pixel(rays, threads, [&](std::size_t pixel, const glm::dvec3& direction) {
    claims[pixel] = best_claim(part, scene, eye, direction, nearest[pixel], tolerance);
  });
  return claims;
}

Raster make_raster(const Scene& scene, const Camera& camera, int supersample,
                   const std::vector<PixelClaim>& claims) {
  const PixelRays rays(camera, supersample);
  const glm::dvec3 eye = camera.eye - scene.origin;
  Raster raster;
  raster.width = rays.width();
  raster.height = rays.height();
  raster.depth.assign(claims.size(), kInfinity);
  raster.patch.assign(claims.size(), kNoPatch);
  raster.element.assign(claims.size(), kNoElement);
  raster.front.assign(claims.size(), 0);
  for (std::size_t pixel = 0; pixel < claims.size(); ++pixel) {
    const auto width = static_cast<std::size_t>(raster.width);
    const glm::dvec3 direction =
        rays.direction(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
    const SeenPlace seen = place_of(scene, eye, direction, claims[pixel]);
    raster.patch[pixel] = seen.patch;
    raster.depth[pixel] = seen.depth;
    raster.front[pixel] = seen.front ? 1 : 0;
  }
  return raster;
}

std::vector<SeenPlace> see(const RayScene& whole, const Scene& scene, const Camera& camera,
                           std::span<const glm::dvec2> places, int threads) {
  const PixelRays rays(camera);
  const glm::dvec3 eye = camera.eye - scene.origin;
  const double tolerance = depth_tolerance(scene, camera);
  std::vector<SeenPlace> seen(places.size());
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t k) {
      const glm::dvec3 direction = rays.towards(places[k].x, places[k].y);
      const double nearest = nearest_depth(whole, eye, direction, tolerance);
      seen[k] = place_of(scene, eye, direction, best_claim(whole, scene, eye, direction, nearest, tolerance));
    });
  });
  return seen;
}

glm::dvec3 pixel_point(const Scene& scene, const Camera& camera, const PixelRays& rays, const Raster& raster,
                       std::size_t pixel) {
  const auto width = static_cast<std::size_t>(raster.width);
  const glm::dvec3 direction =
      rays.direction(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
  return camera.eye - scene.origin + raster.depth[pixel] * direction;
}

double least_pixel_spacing(const Camera& camera, int supersample, double depth) {
  const PixelRays rays(camera, supersample);
  const glm::dvec3 corner = rays.direction(0, 0);
  const double across = rays.width() > 1 ? glm::distance(corner, rays.direction(1, 0)) : kInfinity;
  const double down = rays.height() > 1 ? glm::distance(corner, rays.direction(0, 1)) : kInfinity;
  return depth * std::min(across, down) / glm::length(corner);
}

void require_view(const Scene& scene, const Raster& raster) {
  bool sees_something = false;
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel) {
    if (raster.patch[pixel] == kNoPatch) continue;
    sees_something = true;
    const std::uint32_t side = raster.front[pixel] != 0 ? kFront : kBack;
    if ((scene.patch(raster.patch[pixel]).sides & side) != 0) return;
  }
  if (!sees_something)
    throw InputError(
        "the camera sees nothing: no ray through a pixel meets the scene (check --eye, --look-at and "
        "--fov against the scene's bounds)");
  throw InputError(
      "the camera sees only backs: every surface in view is seen from a side that neither sends nor "
      "receives light, as from inside or behind a closed body (move --eye, turn the faces, or use "
      "--sides two)");
}

}  // namespace fluxel
