#pragma once

#include <span>
#include <string>

#include "core/element.hpp"
#include "core/rgb.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Light of elements that face another surface across less than a third of their length.
struct NarrowGaps {
  double share = 0;  ///< of all light that arrives
  /// Where most of that is: groups of the element and of what it faces, across at least so much, with
  /// elements as long as this [m].
  std::string group, other;
  double width = 0, length = 0;
};

/// How much light elements receive in gaps, behind slats and in slits that they are too large for: there
/// their light changes within an element, and coarser meshes, which see no more of it, do not tell. By rays
/// along the normals from some places of each element, where they meet what lies opposite. `H` is of the
/// sides, [W/m2]: fronts, then backs if any.
[[nodiscard]] NarrowGaps find_narrow_gaps(const RayScene& ray_scene, const ElementView& mesh,
                                          std::span<const Rgb> H);

}  // namespace fluxel
