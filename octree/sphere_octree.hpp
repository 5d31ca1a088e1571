#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "octree/octree_arrays.hpp"

namespace fluxel {

/// Finds the spheres that hold a point, in one leaf. The same for any number of threads, byte by byte.
class SphereOctree {
 public:
  /// The spheres' numbers are those of the look-ups. Throws std::invalid_argument of one that is not finite,
  /// or whose radius is below 0.
  SphereOctree(std::span<const Sphere> spheres, int threads);

  /// Calls `visit` with the number of each sphere that may hold the point, ascending: none that does is left
  /// out.
  template <class Visit>
  void for_each_at(const glm::dvec3& point, const Visit& visit) const {
    view().for_each_at(point.x, point.y, point.z, visit);
  }

  [[nodiscard]] OctreeView view() const { return arrays_.view(); }
  [[nodiscard]] std::span<const OctreeNode> nodes() const { return arrays_.nodes; }
  [[nodiscard]] std::span<const std::uint32_t> references() const { return arrays_.references; }

 private:
  OctreeArrays arrays_;
};

}  // namespace fluxel
