#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "visibility/cuda/device.hpp"
#include "visibility/cuda/hit_finder.hpp"

namespace fluxel::cuda {

/// Finds on a GPU what rays meet first.
class DeviceHits final : public HitFinder {
 public:
  /// Copies the scene to a device. Throws DeviceError where it needs more than `memory` bytes there, or the
  /// device cannot be used.
  DeviceHits(const SceneArrays& scene, int device, std::size_t memory);
  ~DeviceHits() override;

  [[nodiscard]] std::size_t rays_at_once() const override;
  [[nodiscard]] std::vector<NearestHit> find(const std::vector<Ray>& rays) override;

  /// Of all that has been found.
  [[nodiscard]] DeviceSeconds seconds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel::cuda
