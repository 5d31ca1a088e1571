#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "visibility/cuda/hit_finder.hpp"
#include "visibility/cuda/verified_counts.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Of first hits on a device, those that may be others than Embree's: of patches that are met by rounding
/// alone, at an edge or along their plane. Rays that are aimed at edges and corners are in one of 100.
inline constexpr double kMostDifferingHits = 1e-3;

/// A rank's GPU, which finds first hits in place of a RayScene; some of them the RayScene finds again. For
/// one thread at a time, whose task arena works on what the processor does.
class VerifiedHits {
 public:
  /// `patches`: the number of each patch by its place in the finder's scene. The ray scene must outlive this.
  /// `verified`: the share of the rays that it traces again.
  VerifiedHits(std::unique_ptr<cuda::HitFinder> finder, std::vector<PatchId> patches,
               const RayScene& ray_scene, double verified);

  /// How many rays should be given at a time.
  [[nodiscard]] std::size_t rays_at_once() const { return finder_->rays_at_once(); }

  /// As RayScene::first_hit of each ray, but for what Embree does not tell apart. Where the device fails the
  /// processor traces these rays, and all others from then on.
  void find(std::span<const Ray> rays, std::span<PatchHit> hits);

  [[nodiscard]] const VerifiedCounts& counts() const { return counts_; }
  /// A sentence; empty: the device has not failed.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  void by_device(std::span<const Ray> rays, std::span<PatchHit> hits);
  void by_processor(std::span<const Ray> rays, std::span<PatchHit> hits) const;
  void verify(std::span<const Ray> rays, std::span<const PatchHit> hits);

  std::unique_ptr<cuda::HitFinder> finder_;
  std::vector<PatchId> patches_;
  const RayScene& ray_scene_;
  double verified_;
  VerifiedCounts counts_;
  std::string failure_;
};

/// PatchIds of the places in a scene for devices.
[[nodiscard]] std::vector<PatchId> patches_of(const cuda::SceneArrays& arrays);

}  // namespace fluxel
