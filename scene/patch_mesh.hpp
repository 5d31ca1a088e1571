#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ids.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Patches connected over shared edges.
struct PatchComponent {
  std::vector<PatchId> patches;  ///< ascending
  bool closed = true;            ///< no boundary edge
  bool oriented = true;  ///< every shared edge joins two patches, which run along it in opposite directions
};

struct PatchMesh {
  std::vector<PatchComponent> components;        ///< by their lowest patch
  std::vector<std::uint32_t> component;          ///< of each patch
  std::vector<glm::dvec3> places;                ///< the welded corners [m], each where it was first used
  std::vector<Outline<std::uint32_t>> outlines;  ///< of each patch: its corners' places
  std::size_t boundary_edges = 0;                ///< used by one patch
  std::size_t nonmanifold_edges = 0;             ///< used by more than two
  std::size_t flipped_edges = 0;                 ///< used by two that run along it in the same direction
};

/// Builds the half-edge mesh of the patches (Botsch et al. 2002, OpenMesh) and says how they hang together.
/// Corners nearer than 1e-6 of the scene's diagonal are one vertex. A patch that a half-edge structure cannot
/// hold beside the others (a third one at an edge, a flipped neighbour) gets vertices of its own: nothing is
/// lost, and its edges are still matched with the others by their welded corners. A long edge against two
/// short ones (a T-junction) is not shared: all three are boundary edges.
[[nodiscard]] PatchMesh connect_patches(const Scene& scene);

}  // namespace fluxel
