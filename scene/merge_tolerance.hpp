#pragma once

#include <algorithm>
#include <limits>

#include "scene/contact_pairs.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// How far merging may move a surface. Below the rounding of single precision, in which elements are kept and
/// rays run, nothing is told apart; beyond it tilts and changes of outline are held to the patch's own size,
/// as of polygons that are read (to_patches.cpp), so that small things in large scenes keep their shape.
struct MergeTolerance {
  explicit MergeTolerance(const Scene& scene)
      : rounding(scene.extent * static_cast<double>(std::numeric_limits<float>::epsilon())),
        touching(std::max(0.5 * contact_tolerance(scene), rounding)) {}

  /// By how much the heights of a patch's corners over the common plane may differ; `width` is its least [m].
  [[nodiscard]] double tilt(double width) const { return std::clamp(1e-4 * width, rounding, touching); }

  /// Of corners from the edges of an outline whose longest edge is that long [m].
  [[nodiscard]] double outline(double longest_edge) const { return std::max(1e-6 * longest_edge, rounding); }

  double rounding;  ///< of single precision at the scene's largest coordinate [m]
  double touching;  ///< from the common plane: two surfaces so far from it on both sides still touch [m]
};

}  // namespace fluxel
