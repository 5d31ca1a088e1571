#pragma once

#include "scene/scene.hpp"

namespace fluxel {

/// What rays and segments meet, decided in double precision. Along a line a corner has one place, the same
/// for all patches that share it, and on which side of the line an edge between two places passes is decided
/// exactly: nothing slips between patches that share edges or corners. This needs products and sums that are
/// rounded each for itself. A line through an edge or a corner counts as moved a little, in a direction that
/// depends on the line alone.

/// Whether a segment meets a patch; its ends lie on different sides of the plane.
[[nodiscard]] bool segment_meets(const Patch& patch, const glm::dvec3& from, const glm::dvec3& to);

/// Whether a ray does, however far; it heads for the plane from one side.
[[nodiscard]] bool ray_meets(const Patch& patch, const glm::dvec3& from, const glm::dvec3& direction);

/// Where a line meets the patch's plane, by its parameter.
[[nodiscard]] double plane_parameter(const Patch& patch, const glm::dvec3& origin,
                                     const glm::dvec3& direction);

/// How far [m] the edges of a patch are moved outwards for a ray tracer in single precision, so that it
/// proposes all that is met, by the scene's `extent` [m]. Rounding takes about 20 units in the last place of
/// the extent, over the sine of the ray's angle with the plane: the margin is 256 units, but no more than
/// 0.02 of the patch's size and no less than 24 units. A sliver, whose plane single precision hardly knows,
/// gets a thousandth of the extent, but no more than 0.02 of its size. Rays that pass within the margin cost
/// time.
[[nodiscard]] double outline_margin(const Patch& patch, double extent);

/// The outline with edges moved by that much, in its plane. A sharp corner moves by up to eight times that.
[[nodiscard]] Outline<glm::dvec3> enlarged(const Patch& patch, double extent);

}  // namespace fluxel
