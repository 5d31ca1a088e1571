#pragma once

#include <cstdint>
#include <vector>

#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

/// The tree of boxes that rays walk down, of nodes with up to eight children: a binary tree whose largest
/// nodes are opened until eight stand side by side. Boxes are widened by what rounding needs.
struct WideTree {
  std::vector<WideNode> nodes;       ///< the root first; none without patches
  std::vector<std::uint32_t> order;  ///< the patches, leaf after leaf

  /// `extent` [m]: the scene's largest coordinate. Throws DeviceError where a path has more than
  /// kMaxLevels nodes.
  WideTree(const std::vector<ExactPatch>& patches, float extent);
};

}  // namespace fluxel::cuda
