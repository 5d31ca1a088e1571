#pragma once

#include <cstdint>
#include <span>

#include "core/element.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// A hash of all that the visibility bits of these elements depend on: their geometry and unknown sides, the
/// patches, the scene's size, the instruction set in use, and the way this program traces. Light,
/// reflectances, solver, picture, threads and ranks change nothing in it.
[[nodiscard]] std::uint64_t visibility_identity(const RayScene& ray_scene, std::span<const Element> elements);

}  // namespace fluxel
