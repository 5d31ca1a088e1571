#include "scene/merge_patches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "scene/coplanar_regions.hpp"
#include "scene/merge_region.hpp"
#include "scene/polygon.hpp"

namespace fluxel {
namespace {

/// Gives the outline to a patch, with corners at the places; the rest is that of its parts.
void reshape(Patch& patch, const Outline<std::uint32_t>& outline, const std::vector<glm::dvec3>& places) {
  patch.outline.corners = outline.corners;
  for (std::size_t i = 0; i < outline.corners; ++i) patch.outline.corner[i] = places[outline.corner[i]];
  const glm::dvec3 area = area_vector(corners(patch.outline));
  patch.area = glm::length(area);
  patch.normal = area / patch.area;
}

/// Leaves out what is marked, in `items` and in the mesh.
template <class Item>
void drop(std::vector<Item>& items, const std::vector<bool>& dropped) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!dropped[i]) items[kept++] = items[i];
  }
  items.resize(kept);
}

void list_patches(PatchMesh& mesh) {
  for (PatchComponent& component : mesh.components) component.patches.clear();
  for (std::uint32_t patch = 0; patch < mesh.component.size(); ++patch)
    mesh.components[mesh.component[patch]].patches.push_back(PatchId{patch});
}

}  // namespace

void merge_patches(Scene& scene, PatchMesh& mesh) {
  const MergeTolerance tolerance(scene);
  std::vector<bool> dropped(scene.patches.size(), false);
  std::size_t merged = 0, made = 0;
  std::vector<MergedPart> parts;
  for (const std::vector<std::uint32_t>& region : coplanar_regions(scene, mesh, tolerance)) {
    parts.clear();
    for (const std::uint32_t patch : region) {
      parts.push_back({mesh.outlines[patch], patch});
      dropped[patch] = true;
    }
    for (const MergedPart& part : merge_region(parts, mesh.places, tolerance)) {
      dropped[part.lowest] = false;
      if (part.patches == 1) continue;
      reshape(scene.patches[part.lowest], part.outline, mesh.places);
      mesh.outlines[part.lowest] = part.outline;
      merged += part.patches;
      ++made;
    }
  }
  if (made == 0) return;
  drop(scene.patches, dropped);
  drop(mesh.component, dropped);
  drop(mesh.outlines, dropped);
  list_patches(mesh);
  scene.statistics.merged_patches = merged - made;
  scene.notes.push_back(fmt::format("{} coplanar polygons merged into {}", merged, made));
}

}  // namespace fluxel
