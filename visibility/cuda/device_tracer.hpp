#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "visibility/cuda/scene_arrays.hpp"

namespace fluxel::cuda {

/// What a device or its driver could not do, as a sentence.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct DeviceFacts {
  std::string name;
  std::size_t memory = 0, free_memory = 0;  ///< [bytes]
  int multiprocessors = 0;
  int major = 0, minor = 0;  ///< compute capability
};

/// The devices that this process can use, by number; where there are none, `why_none` is a sentence.
[[nodiscard]] std::vector<DeviceFacts> find_devices(std::string& why_none);

/// What the parts of the work took on the device [s].
struct DeviceSeconds {
  double kernel = 0, transfer = 0;
};

/// Makes tiles of visibility on a device. Results come back through two buffers in turn: one is computed and
/// sent while the host reads the other. For one thread at a time.
class DeviceTracer {
 public:
  /// Copies the scene to a device. Throws DeviceError where it needs more than `memory` bytes there, or the
  /// device cannot be used.
  DeviceTracer(const SceneArrays& scene, int device, std::size_t memory);
  ~DeviceTracer();
  DeviceTracer(DeviceTracer&&) noexcept;
  DeviceTracer& operator=(DeviceTracer&&) noexcept;

  /// Calls take(first, results, count) for consecutive parts of the tiles, in order. Throws DeviceError; what
  /// has been taken until then is right.
  void trace(const std::vector<TilePlace>& places,
             const std::function<void(std::size_t, const TileResult*, std::size_t)>& take);

  /// Of all that has been traced; kernel and transfer of the two buffers overlap.
  [[nodiscard]] const DeviceSeconds& seconds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel::cuda
