#pragma once

#include <cstddef>
#include <vector>

#include "reference/cuda/path_scene.hpp"

namespace fluxel::cuda {

/// Follows paths of light on a device or as a device does. What a path finds depends on the path alone. For
/// one thread at a time.
class PathFollower {
 public:
  virtual ~PathFollower() = default;

  /// How many paths should be given at a time.
  [[nodiscard]] virtual std::size_t paths_at_once() const = 0;

  /// What each path has found, in their order. Throws DeviceError.
  [[nodiscard]] virtual std::vector<PathEstimate> follow(const std::vector<PathBegin>& paths) = 0;
};

}  // namespace fluxel::cuda
