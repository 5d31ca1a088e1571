#pragma once

#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

/// The rounding error of one operation in single precision.
inline constexpr float kUlp = 1.0f / (1 << 24);

/// Of the scene's extent: more than rounding moves a point or a plane of a shaft or a box.
inline constexpr float kBoxMargin = 24 * kUlp;

/// A plane along `axis` that supports two boxes: inside are the x with normal . x >= offset.
struct ShaftPlane {
  std::uint32_t axis;
  float normal_u, normal_v;  ///< along the next axis and the one after it, without unit
  float offset;              ///< a little below the boxes
};

/// The hull of two boxes: their common bounds, and at each corner of their outlines along an axis where one
/// reaches farther in u and the other in v, the plane that cuts the corner off (Haines & Wallace, Shaft
/// culling for efficient ray-traced radiosity, 1991).
inline constexpr std::uint32_t kShaftPlanes = 12;
struct BoxShaft {
  Box bounds;  ///< widened
  ShaftPlane plane[kShaftPlanes];
};

FLUXEL_PORTABLE inline float least_along(const ShaftPlane& plane, const Box& box) {
  const std::uint32_t u = (plane.axis + 1) % 3, v = (plane.axis + 2) % 3;
  return plane.normal_u * (plane.normal_u > 0 ? box.low[u] : box.high[u]) +
         plane.normal_v * (plane.normal_v > 0 ? box.low[v] : box.high[v]);
}

FLUXEL_PORTABLE inline float most_along(const ShaftPlane& plane, const Box& box) {
  const std::uint32_t u = (plane.axis + 1) % 3, v = (plane.axis + 2) % 3;
  return plane.normal_u * (plane.normal_u > 0 ? box.high[u] : box.low[u]) +
         plane.normal_v * (plane.normal_v > 0 ? box.high[v] : box.low[v]);
}

/// Plane k of the shaft between a and b; one that all is inside of where that corner needs none.
FLUXEL_PORTABLE inline ShaftPlane shaft_plane(const Box& a, const Box& b, std::uint32_t k, float extent) {
  const std::uint32_t axis = k / 4, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool high_u = (k & 1) != 0, high_v = (k & 2) != 0;
  const float du = high_u ? a.high[u] - b.high[u] : b.low[u] - a.low[u];
  const float dv = high_v ? a.high[v] - b.high[v] : b.low[v] - a.low[v];
  if (du * dv >= 0) return {axis, 0, 0, -1};
  ShaftPlane plane{axis, (high_u ? -1.0f : 1.0f) * std::fabs(dv), (high_v ? -1.0f : 1.0f) * std::fabs(du), 0};
  plane.offset = lesser(least_along(plane, a), least_along(plane, b)) -
                 kBoxMargin * extent * (std::fabs(du) + std::fabs(dv));
  return plane;
}

FLUXEL_PORTABLE inline Box common_bounds(const Box& a, const Box& b, float extent) {
  Box both{};
  for (int axis = 0; axis < 3; ++axis) {
    both.low[axis] = lesser(a.low[axis], b.low[axis]) - kBoxMargin * extent;
    both.high[axis] = greater(a.high[axis], b.high[axis]) + kBoxMargin * extent;
  }
  return both;
}

/// False only where the box is certainly outside of the shaft.
FLUXEL_PORTABLE inline bool may_meet(const BoxShaft& shaft, const Box& box) {
  for (int axis = 0; axis < 3; ++axis)
    if (box.high[axis] < shaft.bounds.low[axis] || box.low[axis] > shaft.bounds.high[axis]) return false;
  for (const ShaftPlane& plane : shaft.plane)
    if (most_along(plane, box) < plane.offset) return false;
  return true;
}

/// False only where the polygon is certainly outside of the shaft.
FLUXEL_PORTABLE inline bool may_meet(const BoxShaft& shaft, const Occluder& occluder) {
  Box bounds{};
  for (std::uint32_t c = 0; c < 4; ++c) {
    const float corner[3] = {occluder.corner[c].x, occluder.corner[c].y, occluder.corner[c].z};
    for (int axis = 0; axis < 3; ++axis) {
      bounds.low[axis] = c == 0 ? corner[axis] : lesser(bounds.low[axis], corner[axis]);
      bounds.high[axis] = c == 0 ? corner[axis] : greater(bounds.high[axis], corner[axis]);
    }
  }
  if (!may_meet(shaft, bounds)) return false;
  for (const ShaftPlane& plane : shaft.plane) {
    bool outside = true;
    for (const Float3& at : occluder.corner) {
      const float corner[3] = {at.x, at.y, at.z};
      outside = outside && plane.normal_u * corner[(plane.axis + 1) % 3] +
                                   plane.normal_v * corner[(plane.axis + 2) % 3] <
                               plane.offset;
    }
    if (outside) return false;
  }
  return true;
}

}  // namespace fluxel::cuda
