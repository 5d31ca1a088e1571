#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visibility/convex_body.hpp"
#include "visibility/occlusion.hpp"

namespace fluxel {

/// Half the diagonal of a bundle's hulls, their mean [m].
[[nodiscard]] float mean_radius(const RayBundle& bundle);

/// Moves to the front of the list the bodies that are likely to hide most of the bundle: those that reach
/// farthest around the axis between the centres of its hulls, the farthest first, at most `most` and none
/// narrower than `least_breadth` [m]. Returns how many; the order of the others is of no matter.
[[nodiscard]] std::size_t largest_first(const RayBundle& bundle, std::span<const ConvexBody> bodies,
                                        std::size_t most, float least_breadth,
                                        std::vector<std::uint32_t>& numbers);

}  // namespace fluxel
