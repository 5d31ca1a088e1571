#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.hpp"
#include "core/raster.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// What the raster's pixels see, as points of the tree's faces; without a face where nothing is seen or no
/// unknown.
[[nodiscard]] std::vector<GatherPoint> seen_points_of(const NodeTree& tree, const Camera& camera,
                                                      int supersample, const Raster& raster);

/// Some of the points that reflect and do not emit, by their numbers, from all parts of the picture: their
/// radiosity tells how far the solution is.
[[nodiscard]] std::vector<std::uint32_t> choose_probes(const NodeTree& tree,
                                                       std::span<const GatherPoint> points);

}  // namespace fluxel
