#pragma once

#include <cstdint>
#include <vector>

#include "hierarchy/gather.hpp"
#include "hierarchy/node_tree.hpp"
#include "method/light_map.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Where the texels of a light map are looked at.
struct LightMapPoints {
  std::vector<std::uint32_t> chart;  ///< of each texel of the map, or LightMap::kNone
  std::vector<std::uint32_t> point;  ///< likewise, of `points`
  std::vector<GatherPoint> points;
  std::vector<std::uint32_t> texel;  ///< of each point, the first that shows it
};

/// A point for the middle of each texel within a step of a chart's piece. A middle beside its piece is looked
/// at where another piece of the plane has it, if nothing stands between, so that bilinear interpolation is
/// the same on both sides of the edge; else at the nearest place of the piece itself. Places are a tenth of a
/// texel inside of the outlines, or as far as narrow pieces allow, on the right side of what stands there.
[[nodiscard]] LightMapPoints points_of(const LightMapLayout& layout, const NodeTree& tree,
                                       const RayScene& ray_scene);

}  // namespace fluxel
