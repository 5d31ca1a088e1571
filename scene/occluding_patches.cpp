#include "scene/occluding_patches.hpp"

#include "scene/merge_patches.hpp"
#include "scene/patch_mesh.hpp"

namespace fluxel {

Scene occluding_patches(const Scene& scene) {
  Scene merged;
  merged.extent = scene.extent;
  if (scene.statistics.convex) return merged;
  merged.patches = scene.patches;
  for (Patch& patch : merged.patches) {
    patch.material = MaterialId{0};
    patch.group = GroupId{0};
  }
  PatchMesh mesh = connect_patches(merged);
  merge_patches(merged, mesh);
  return merged;
}

}  // namespace fluxel
