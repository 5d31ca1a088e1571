#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "visibility/cuda/device.hpp"
#include "visibility/cuda/scene_arrays.hpp"
#include "visibility/cuda/tile_device.hpp"

namespace fluxel::cuda {

/// Makes tiles on a GPU. Results come back through two buffers in turn: one is computed and sent while the
/// host reads the other.
class DeviceTracer final : public TileDevice {
 public:
  /// Copies the scene to a device. Throws DeviceError where it needs more than `memory` bytes there, or the
  /// device cannot be used.
  DeviceTracer(const SceneArrays& scene, int device, std::size_t memory);
  ~DeviceTracer() override;

  void trace(const std::vector<TilePlace>& places, const Take& take) override;

  /// Of all that has been traced; kernel and transfer of the two buffers overlap.
  [[nodiscard]] const DeviceSeconds& seconds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel::cuda
