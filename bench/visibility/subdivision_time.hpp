#pragma once

#include <cstddef>

#include "core/camera.hpp"
#include "scene/scene.hpp"

namespace fluxel::bench {

/// The subdivision step of a run of one rank and one thread; medians of the repetitions [s].
struct SubdivisionTime {
  std::size_t elements = 0;
  double raster_seconds = 0;  ///< ray scene, depths, claims, raster
  double split_seconds = 0;   ///< pixels sorted down the patches' trees
};

/// With the camera's resolution set to `resolution` x `resolution`, and the default bound of edges for what
/// the camera does not see. As subdivide_scene does it, without its check whether a visibility matrix of the
/// elements would fit into memory: nobody makes one here.
[[nodiscard]] SubdivisionTime time_subdivision(const Scene& scene, Camera camera, int resolution,
                                               int repetitions);

}  // namespace fluxel::bench
