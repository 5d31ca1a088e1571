#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace fluxel {

/// Segments from the origins to origin + direction, a coordinate an array of `count`.
struct SegmentLanes {
  const float *origin_x, *origin_y, *origin_z, *direction_x, *direction_y, *direction_z;
  unsigned count;  ///< up to 16
};

/// Which of the segments whose bits are set in `asked` meet the patch: what segment_meets says of each, with
/// its roundings, many at a time.
[[nodiscard]] std::uint32_t segments_meet(const Patch& patch, const SegmentLanes& segments,
                                          std::uint32_t asked);

}  // namespace fluxel
