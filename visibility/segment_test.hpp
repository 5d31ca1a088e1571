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

/// The outline that a ray tracer in single precision has to be given, so that it proposes all that is met:
/// with edges moved outwards in its plane. Rounding takes about 20 units of `extent` [m], the scene's, over
/// the sine of the ray's angle with the plane; the margin is a thousandth of the extent, but no more than a
/// fiftieth of the patch's size, and no less than 24 units. A sharp corner moves by up to eight times that.
[[nodiscard]] Outline<glm::dvec3> enlarged(const Patch& patch, double extent);

}  // namespace fluxel
