#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <vector>

#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

/// What a device or its driver could not do, as a sentence.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Something that makes tiles of visibility, many at a time. For one thread at a time.
class TileDevice {
 public:
  virtual ~TileDevice() = default;

  /// The results of `count` tiles from place `first` on.
  using Take = std::function<void(std::size_t first, const TileResult* results, std::size_t count)>;

  /// Calls `take` for consecutive parts of the tiles, in order. Throws DeviceError; what has been taken until
  /// then is right.
  virtual void trace(const std::vector<TilePlace>& places, const Take& take) = 0;
};

}  // namespace fluxel::cuda
