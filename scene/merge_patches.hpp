#pragma once

#include "scene/patch_mesh.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Replaces coplanar patches of one material and one group that hang together over whole edges by larger
/// triangles and parallelograms, where the surface stays what it is (see coplanar_regions.hpp and
/// merge_region.hpp). A merged patch stands where its lowest part stood; the order of the others is kept.
///
/// `mesh` is of the scene's patches and becomes that of the merged ones, which belong to the components of
/// their parts: since a component's edges meet T-junctions then, its statistics stay those of the parts.
/// Pieces are made after this. Counts and notes what it merged.
void merge_patches(Scene& scene, PatchMesh& mesh);

}  // namespace fluxel
