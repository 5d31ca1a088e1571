#pragma once

#include <utility>
#include <vector>

#include "reference/cuda/host_paths.hpp"
#include "visibility/cuda/device.hpp"
#include "visibility/cuda/hit_finder.hpp"

namespace fluxel {

/// The GPU's code on the host, given few paths at a time. It fails when it has been called so often, and
/// finds twice the light on every second path where it is `faulty`.
class TestFollower final : public cuda::PathFollower {
 public:
  static constexpr std::size_t kForEver = ~std::size_t{0};

  explicit TestFollower(cuda::PathArrays arrays, std::size_t calls_until_failure = kForEver,
                        bool faulty = false)
      : arrays_(std::move(arrays)), left_(calls_until_failure), faulty_(faulty) {}

  [[nodiscard]] std::size_t paths_at_once() const override { return 1000; }

  [[nodiscard]] std::vector<cuda::PathEstimate> follow(const std::vector<cuda::PathBegin>& paths) override {
    if (left_ == 0) throw cuda::DeviceError("the GPU could not follow paths: planted");
    --left_;
    std::vector<cuda::PathEstimate> found = cuda::HostPaths(arrays_).follow(paths);
    for (std::size_t k = 0; faulty_ && k < found.size(); k += 2)
      found[k].irradiance = 2.0 * found[k].irradiance;
    return found;
  }

 private:
  cuda::PathArrays arrays_;
  std::size_t left_;
  bool faulty_;
};

/// Likewise of first hits: nothing is met by every second ray where it is `faulty`.
class TestHits final : public cuda::HitFinder {
 public:
  explicit TestHits(cuda::SceneArrays arrays, std::size_t calls_until_failure = TestFollower::kForEver,
                    bool faulty = false)
      : arrays_(std::move(arrays)), left_(calls_until_failure), faulty_(faulty) {}

  [[nodiscard]] std::size_t rays_at_once() const override { return 1000; }

  [[nodiscard]] std::vector<cuda::NearestHit> find(const std::vector<cuda::Ray>& rays) override {
    if (left_ == 0) throw cuda::DeviceError("the GPU could not find hits: planted");
    --left_;
    std::vector<cuda::NearestHit> found = cuda::HostHits(arrays_).find(rays);
    for (std::size_t k = 0; faulty_ && k < found.size(); k += 2) found[k] = {0, cuda::kNoHit};
    return found;
  }

 private:
  cuda::SceneArrays arrays_;
  std::size_t left_;
  bool faulty_;
};

}  // namespace fluxel
