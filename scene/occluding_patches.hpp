#pragma once

#include "scene/scene.hpp"

namespace fluxel {

/// The scene as that which stands in the way: patches alone, coplanar ones merged whatever their groups and
/// materials (see merge_patches.hpp), so that a wall of many squares is one; none where the scene is convex.
[[nodiscard]] Scene occluding_patches(const Scene& scene);

}  // namespace fluxel
