#pragma once

#include "reference/cuda/path_arrays.hpp"
#include "reference/light_paths.hpp"

namespace fluxel {

/// The scene as a GPU takes it to follow paths of light.
[[nodiscard]] cuda::PathArrays path_arrays(const RayScene& ray_scene);

/// A path as a GPU takes it.
[[nodiscard]] cuda::PathBegin path_begin(const PathStart& start);

}  // namespace fluxel
