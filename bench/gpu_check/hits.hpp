#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/gpu_check/scenes.hpp"
#include "visibility/cuda/nearest_hit.hpp"

namespace fluxel::cuda::checks {

/// Whether nearest hits in a scene are right, and how many rays are followed a second.
struct HitFigures {
  std::string scene;
  std::size_t patches = 0;
  std::uint64_t rays = 0, hits = 0, differing = 0;                       ///< of the host against brute force
  std::uint64_t device_rays = 0, device_hits = 0, device_differing = 0;  ///< of the device against the host
  double host_rays_per_second = 0;                                       ///< on one core
  double device_rays_per_second = 0;                                     ///< copies of rays and hits included
  double kernel_rays_per_second = 0;

  [[nodiscard]] bool right() const { return differing == 0 && device_differing == 0; }
};

/// How many rays: compared with brute force so many that about `patch_tests` are made.
struct HitEffort {
  double patch_tests;
  std::size_t timed_rays;
};

/// Rays from points in the scene and far outside in any direction, through corners, edges and points of
/// patches, along the axes, and past everything.
[[nodiscard]] std::vector<Ray> rays_through(const CheckScene& scene, std::size_t count);

/// What a ray meets first, by the test with each patch and nothing else.
[[nodiscard]] NearestHit hit_by_brute_force(const TileScene& scene, const Ray& ray);

/// On the host, and on device number `device` where that is not negative. Differences are printed. Throws
/// DeviceError.
[[nodiscard]] HitFigures check_hits(const CheckScene& scene, const HitEffort& effort, int device,
                                    unsigned threads);

void print_hits(const std::vector<HitFigures>& figures);

[[nodiscard]] std::string to_json(const std::vector<HitFigures>& figures);

}  // namespace fluxel::cuda::checks
