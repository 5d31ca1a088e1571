#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "visibility/cuda/device.hpp"
#include "visibility/cuda/nearest_hit.hpp"
#include "visibility/cuda/scene_arrays.hpp"

namespace fluxel::cuda {

/// Finds on a GPU what rays meet first. For one thread at a time.
class DeviceHits {
 public:
  /// Copies the scene to a device. Throws DeviceError where it needs more than `memory` bytes there, or the
  /// device cannot be used.
  DeviceHits(const SceneArrays& scene, int device, std::size_t memory);
  ~DeviceHits();

  /// What each of the rays meets, in their order. Throws DeviceError.
  [[nodiscard]] std::vector<NearestHit> find(const std::vector<Ray>& rays);

  /// Of all that has been found.
  [[nodiscard]] DeviceSeconds seconds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel::cuda
