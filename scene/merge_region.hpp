#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "scene/merge_tolerance.hpp"

namespace fluxel {

/// Patches of a plane that are one triangle or parallelogram together, or one patch alone.
struct MergedPart {
  Outline<std::uint32_t> outline;  ///< places of the corners
  std::uint32_t lowest = 0;        ///< patch
  double deviation = 0;            ///< [m], of its patches' outline from that, at most
  std::size_t patches = 1;
};

/// Merges the patches of one region (ascending by number; see coplanar_regions.hpp) into fewer. Where their
/// common outline is a triangle or a parallelogram, however they divide it, they become one; else two that
/// share a whole edge are joined wherever that makes a triangle or a parallelogram, until none are left:
/// triangles to parallelograms over the longest edges first, then rows of parallelograms, then rows of rows.
/// Corners that fall away lie within the tolerance of the outline; the first corner is the first of the
/// lowest patch that stays one. Ascending by lowest patch.
[[nodiscard]] std::vector<MergedPart> merge_region(std::span<const MergedPart> patches,
                                                   std::span<const glm::dvec3> places,
                                                   const MergeTolerance& tolerance);

}  // namespace fluxel
