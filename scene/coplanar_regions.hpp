#pragma once

#include <cstdint>
#include <vector>

#include "scene/merge_tolerance.hpp"
#include "scene/patch_mesh.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Sets of two patches and more that hang together over whole shared edges, in one plane, of one material and
/// one group, facing the same way: what may be merged. Each ascending, the sets by their lowest patch.
///
/// An edge joins two patches that run along it in opposite directions, where neither has a second such
/// partner there (a duplicate); patches of other planes or materials at the edge do not matter. A set lies
/// within `tolerance` of the plane of its area vector; where it does not, it falls into sets around its
/// largest patches.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> coplanar_regions(const Scene& scene,
                                                                       const PatchMesh& mesh,
                                                                       const MergeTolerance& tolerance);

}  // namespace fluxel
