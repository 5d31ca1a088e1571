#pragma once

#include "reference/cuda/light_path.hpp"
#include "reference/cuda/path_arrays.hpp"
#include "reference/cuda/path_follower.hpp"

namespace fluxel::cuda {

/// What the device makes of paths, by the same code on the host, by one thread: to test it.
class HostPaths final : public PathFollower {
 public:
  /// The arrays must outlive this.
  explicit HostPaths(const PathArrays& arrays) : scene_(arrays.view()) {}

  [[nodiscard]] std::size_t paths_at_once() const override { return 1024; }

  [[nodiscard]] std::vector<PathEstimate> follow(const std::vector<PathBegin>& paths) override {
    std::vector<PathEstimate> found;
    found.reserve(paths.size());
    for (const PathBegin& path : paths) found.push_back(LightPath(scene_, path).follow());
    return found;
  }

 private:
  PathScene scene_;
};

}  // namespace fluxel::cuda
