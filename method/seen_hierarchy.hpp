#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/raster.hpp"
#include "hierarchy/hierarchy.hpp"
#include "method/problem.hpp"

namespace fluxel {

/// A hierarchy, and the points from which a picture sees it; none without a camera.
struct SeenHierarchy {
  std::unique_ptr<Hierarchy> hierarchy;
  bool by_rays = false;                     ///< how its nodes exchange light; else by links
  std::vector<GatherPoint> points;          ///< of the raster's pixels
  std::vector<std::uint32_t> probe_pixels;  ///< those at which the error is looked at
  std::vector<GatherPoint> probes;          ///< their points
};

/// Of gathers at single points, how many take as long as the picture.
[[nodiscard]] double work_of_picture(const Options& options, const SeenHierarchy& seen);

/// Collective: the hierarchy of the problem before its first round. It hears signals (see handle_signals);
/// what importance it gives to its nodes comes from the probes.
[[nodiscard]] SeenHierarchy see_hierarchy(const Problem& problem, const Raster& raster);

}  // namespace fluxel
