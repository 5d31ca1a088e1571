#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "octree/octree_view.hpp"

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

  [[nodiscard]] OctreeView view() const {
    return {nodes_.data(), references_.data(), {low_.x, low_.y, low_.z}, edge_, margin_};
  }
  [[nodiscard]] std::span<const OctreeNode> nodes() const { return nodes_; }
  [[nodiscard]] std::span<const std::uint32_t> references() const { return references_; }

 private:
  class Pass;

  glm::dvec3 low_{0};
  double edge_ = 1, margin_ = 0;
  std::vector<OctreeNode> nodes_;
  std::vector<std::uint32_t> references_;
};

}  // namespace fluxel
