#pragma once

#include "scene/patch_mesh.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Whether nothing of a scene stands in the open: every component has no free edge, or lies within closed
/// components or on them, as panels that hang in a room, partitions and pictures on a wall do. It lies within
/// where all its patches do, by their corners and centroids, on one of their two sides: points that a
/// consistently oriented component winds around, or from which 32 directions all meet another one. Where the
/// camera is does not matter. Takes the mesh of the scene's patches; of more than 5e7 tests of a patch the
/// answer is no.
[[nodiscard]] bool is_closed(const Scene& scene, const PatchMesh& mesh);

/// Whether the front of some emitter, at its centroid, is within a closed component (as above).
[[nodiscard]] bool is_lit_inside(const Scene& scene, const PatchMesh& mesh);

}  // namespace fluxel
