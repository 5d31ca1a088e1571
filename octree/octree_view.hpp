#pragma once

// Portable: what a device compiles too (see visibility/cuda/portable.hpp).

#include <cstdint>

#include "core/portable.hpp"

namespace fluxel {

struct Sphere {
  float x, y, z, radius;
};

/// A cube of an octree, halved along each axis, or a leaf that refers to spheres.
struct OctreeNode {
  static constexpr std::uint32_t kInner = 0xFFFFFFFFu;

  std::uint32_t first;  ///< of eight children, or of the references
  std::uint32_t count;  ///< of references; kInner: there are children
};

/// Levels below the root.
inline constexpr int kOctreeLevels = 20;

/// Where a cube of a level lies, in its edges from the root's lowest corner.
struct OctreePlace {
  std::uint32_t x, y, z;

  /// Of the children of the cube, bits of z, y, x from the lowest.
  [[nodiscard]] FLUXEL_PORTABLE OctreePlace child(std::uint32_t number) const {
    return {x << 1 | (number >> 2 & 1u), y << 1 | (number >> 1 & 1u), z << 1 | (number & 1u)};
  }
};

/// An octree of references (Frolov et al. 2014): each leaf refers to all spheres that reach into it.
struct OctreeView {
  const OctreeNode* nodes;
  const std::uint32_t* references;
  double low[3];  ///< the root's lowest corner
  double edge;    ///< of the root
  double margin;  ///< more than what rounding may take from a cube

  /// The children of a cube that a sphere may reach into, a bit each.
  [[nodiscard]] FLUXEL_PORTABLE std::uint32_t children_met(const OctreePlace& of, int level,
                                                           const Sphere& sphere) const {
    const double half = edge / static_cast<double>(2u << level);
    double gap[3][2];  // squared, to the lower and the upper half along each axis
    const double centre[3] = {sphere.x, sphere.y, sphere.z};
    const std::uint32_t place[3] = {of.x, of.y, of.z};
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const double from = low[axis] + half * (2.0 * place[axis] + side) - margin;
        const double until = from + half + 2 * margin;
        const double apart = centre[axis] < from ? from - centre[axis] : centre[axis] - until;
        gap[axis][side] = apart > 0 ? apart * apart : 0;
      }
    }
    const double reach = static_cast<double>(sphere.radius) * sphere.radius;
    std::uint32_t met = 0;
    for (std::uint32_t child = 0; child < 8; ++child) {
      const double squared = gap[0][child >> 2] + gap[1][child >> 1 & 1u] + gap[2][child & 1u];
      met |= squared <= reach ? 1u << child : 0u;
    }
    return met;
  }

  /// Calls `visit` with the number of each sphere that may hold the point, ascending: none that does is left
  /// out.
  template <class Visit>
  FLUXEL_PORTABLE void for_each_at(double x, double y, double z, const Visit& visit) const {
    const double scale = static_cast<double>(1u << kOctreeLevels) / edge;
    const double at[3] = {(x - low[0]) * scale, (y - low[1]) * scale, (z - low[2]) * scale};
    std::uint32_t place[3];
    for (int axis = 0; axis < 3; ++axis) {
      if (!(at[axis] >= 0 && at[axis] < static_cast<double>(1u << kOctreeLevels))) return;
      place[axis] = static_cast<std::uint32_t>(at[axis]);
    }
    OctreeNode node = nodes[0];
    for (int bit = kOctreeLevels - 1; node.count == OctreeNode::kInner; --bit)
      node = nodes[node.first +
                   ((place[0] >> bit & 1u) << 2 | (place[1] >> bit & 1u) << 1 | (place[2] >> bit & 1u))];
    for (std::uint32_t k = 0; k < node.count; ++k) visit(references[node.first + k]);
  }
};

}  // namespace fluxel
