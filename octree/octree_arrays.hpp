#pragma once

// Portable: what the program that checks devices compiles too (see visibility/cuda/portable.hpp).

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "octree/octree_view.hpp"

namespace fluxel {

/// The root's cube.
struct OctreeFrame {
  double low[3] = {0, 0, 0};  ///< lowest corner
  double edge = 1;
  double margin = 0;  ///< more than what rounding may take from a cube

  /// With nodes and references in anybody's memory.
  [[nodiscard]] OctreeView view(const OctreeNode* nodes, const std::uint32_t* references) const {
    return {nodes, references, {low[0], low[1], low[2]}, edge, margin};
  }
};

/// An OctreeView's arrays in the memory of the host.
struct OctreeArrays {
  OctreeFrame frame;
  std::vector<OctreeNode> nodes;
  std::vector<std::uint32_t> references;

  /// For as long as this lives and is not changed.
  [[nodiscard]] OctreeView view() const { return frame.view(nodes.data(), references.data()); }
};

/// A cube that all of the spheres lie in.
inline OctreeFrame frame_of(const Sphere* spheres, std::size_t count) {
  OctreeFrame frame;
  if (count == 0) return frame;
  double largest = 0, magnitude = 1e-30;
  for (int axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = 0; k < count; ++k) {
      const Sphere& sphere = spheres[k];
      const double centre = axis == 0 ? sphere.x : axis == 1 ? sphere.y : sphere.z;
      low = std::min(low, centre - static_cast<double>(sphere.radius));
      high = std::max(high, centre + static_cast<double>(sphere.radius));
    }
    frame.low[axis] = low;
    largest = std::max(largest, high - low);
    magnitude = std::max({magnitude, std::fabs(low), std::fabs(high)});
  }
  // A point on the upper faces lies inside too.
  frame.margin = 1e-14 * magnitude;
  frame.edge = largest * (1 + 1e-12) + 4 * frame.margin;
  for (double& low : frame.low) low -= frame.margin;
  return frame;
}

}  // namespace fluxel
