#pragma once

#include <string>
#include <vector>

#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Receivers of which cells or points see nothing but sides that are dark and black, a sentence each: they
/// lie inside bodies or behind surfaces. By rays that depend on the scene alone.
[[nodiscard]] std::vector<std::string> receiver_doubts(const RayScene& ray_scene);

}  // namespace fluxel
