#pragma once

#include <cstddef>
#include <vector>

#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

/// A TileScene's arrays in the memory of the host.
struct SceneArrays {
  std::vector<End> ends;
  std::vector<GroupHull> hulls;
  std::vector<Occluder> occluders;
  std::vector<ExactPatch> exact;
  std::vector<WideNode> nodes;
  float extent = 0, lift = 0;

  /// `scene_extent` [m]: the largest coordinate; `ray_lift` [m]: how far rays begin and end off the planes of
  /// their elements. Throws DeviceError where the tree of patches has too many levels.
  SceneArrays(const std::vector<ExactPatch>& patches, const std::vector<End>& elements, float scene_extent,
              float ray_lift);

  /// For as long as this lives and is not changed.
  [[nodiscard]] TileScene view() const;

  [[nodiscard]] std::size_t bytes() const;
};

}  // namespace fluxel::cuda
