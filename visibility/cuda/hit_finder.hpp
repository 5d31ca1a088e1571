#pragma once

#include <cstddef>
#include <vector>

#include "visibility/cuda/nearest_hit.hpp"
#include "visibility/cuda/scene_arrays.hpp"

namespace fluxel::cuda {

/// Finds on a device, or as a device does, what rays meet first. For one thread at a time.
class HitFinder {
 public:
  virtual ~HitFinder() = default;

  /// How many rays should be given at a time.
  [[nodiscard]] virtual std::size_t rays_at_once() const = 0;

  /// What each of the rays meets, in their order. Throws DeviceError.
  [[nodiscard]] virtual std::vector<NearestHit> find(const std::vector<Ray>& rays) = 0;
};

/// By the same code on the host, by one thread: to test it.
class HostHits final : public HitFinder {
 public:
  /// The arrays must outlive this.
  explicit HostHits(const SceneArrays& arrays) : scene_(arrays.view()) {}

  [[nodiscard]] std::size_t rays_at_once() const override { return 1024; }

  [[nodiscard]] std::vector<NearestHit> find(const std::vector<Ray>& rays) override {
    std::vector<NearestHit> hits;
    hits.reserve(rays.size());
    for (const Ray& ray : rays) hits.push_back(nearest_hit(scene_, ray));
    return hits;
  }

 private:
  TileScene scene_;
};

}  // namespace fluxel::cuda
