#pragma once

#include <cstdint>

#include "scene/scene.hpp"
#include "visibility/triangle_core.hpp"

namespace fluxel {

/// Segments from the origins to origin + direction, a coordinate an array of `count`.
struct SegmentLanes {
  const float *origin_x, *origin_y, *origin_z, *direction_x, *direction_y, *direction_z;
  unsigned count;  ///< up to 16
};

/// Where segments cross the triangle's plane, as barycentric coordinates of two corners, one a segment.
struct Crossings {
  const float *u, *v;
};

/// Which of the segments whose bits are set in `asked` meet the triangle's patch for certain: those that
/// segments_meet would say the same of, and that are not near its edges, end near its plane or graze it.
[[nodiscard]] std::uint32_t segments_surely_meet(const TriangleCore& triangle, const SegmentLanes& segments,
                                                 const Crossings& crossings, std::uint32_t asked);

/// Which of the segments whose bits are set in `asked` meet the patch: what segment_meets says of each, with
/// its roundings, many at a time.
[[nodiscard]] std::uint32_t segments_meet(const Patch& patch, const SegmentLanes& segments,
                                          std::uint32_t asked);

}  // namespace fluxel
