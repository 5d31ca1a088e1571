#pragma once

#include <vector>

#include "reference/cuda/path_scene.hpp"
#include "visibility/cuda/scene_arrays.hpp"

namespace fluxel::cuda {

/// A PathScene's arrays in the memory of the host.
struct PathArrays {
  SceneArrays rays;
  std::vector<std::uint8_t> flags;
  std::vector<PathSide> sides;
  std::vector<EmittingSide> emitters;
  std::vector<double> emitter_ends;
  std::vector<SobolDirections> directions;  ///< one

  /// For as long as this lives and is not changed.
  [[nodiscard]] PathScene view() const {
    return {rays.view(),         flags.data(),    sides.data(),      emitters.data(),
            emitter_ends.data(), emitters.size(), directions.data(), static_cast<double>(rays.lift)};
  }

  [[nodiscard]] std::size_t bytes() const {
    return rays.bytes() + flags.size() + sides.size() * sizeof(PathSide) +
           emitters.size() * (sizeof(EmittingSide) + sizeof(double)) + sizeof(SobolDirections);
  }
};

}  // namespace fluxel::cuda
