#pragma once

#include <glm/vec2.hpp>

#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// How far below its mean a linear function over a face is at its lowest, by its slope times the extents.
[[nodiscard]] double largest_drop(const NodeTree& tree, NodeId face, const glm::dvec2& slope);

/// Of a slope times the extents over the mean, above 1 where a link cannot have it: the function would be
/// negative at a corner, or steeper than kSteepest along an axis.
[[nodiscard]] double steepness(const NodeTree& tree, NodeId face, const glm::dvec2& slope);

/// The slope of the linear function over a face, times the face's extents over its mean, whose mean place is
/// `at`: the best linear fit to what is exchanged with all places of the face, where these have that mean.
/// Made less steep where a link could not have it.
[[nodiscard]] glm::dvec2 seen_slope(const NodeTree& tree, NodeId face, const glm::dvec3& at);

}  // namespace fluxel
