#pragma once

#include "scene/scene.hpp"

namespace fluxel {

/// True where every patch's plane has all patches on one side of it, or within the contact tolerance of it,
/// so that they lie on the surface of a convex body: a line between two of them passes through none, and two
/// elements see each other where they face each other. Says no where finding out would take too long, as of a
/// sphere of more than some ten thousand patches.
[[nodiscard]] bool is_convex(const Scene& scene);

}  // namespace fluxel
