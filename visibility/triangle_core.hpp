#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "scene/scene.hpp"

namespace fluxel {

/// Of a triangle of a patch's enlarged outline, what single precision needs to be sure that a segment that
/// crosses it meets the patch.
struct TriangleCore {
  /// Of the segment's angle with the plane, at least: rounding moves the crossing by the inverse of it.
  static constexpr float kLeastSine = 0.1F;

  glm::vec3 normal{0}, base{0};  ///< of the plane; a point of it
  float least_height = 0;        ///< [m] over the plane, of either end of the segment
  float reach = 0;        ///< [m] along each axis, of the segment's origin from 0, and of half its length
  float least_share = 1;  ///< of each barycentric coordinate of the crossing

  /// `extent` [m] as for `enlarged`, of which `corner` are three.
  TriangleCore(const Patch& patch, const std::array<glm::dvec3, 3>& corner, double extent);
};

}  // namespace fluxel
