#pragma once

#include <memory>

#include "reference/cuda/path_arrays.hpp"
#include "reference/cuda/path_follower.hpp"
#include "visibility/cuda/device.hpp"

namespace fluxel::cuda {

/// Follows paths on a GPU, in blocks of 64: as many at once as the memory set aside for them holds.
class DevicePaths final : public PathFollower {
 public:
  /// Copies the scene to a device. Throws DeviceError where that leaves too little of `memory` [bytes] for
  /// paths, or the device cannot be used.
  DevicePaths(const PathArrays& arrays, int device, std::size_t memory);
  ~DevicePaths() override;

  [[nodiscard]] std::size_t paths_at_once() const override;
  [[nodiscard]] std::vector<PathEstimate> follow(const std::vector<PathBegin>& paths) override;

  /// Of all that has been followed.
  [[nodiscard]] DeviceSeconds seconds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel::cuda
