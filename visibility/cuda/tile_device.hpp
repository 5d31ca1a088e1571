#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "visibility/cuda/device.hpp"
#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

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
