#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace fluxel {

// Round surfaces as polygons: 32 segments around the axis, whose corners stand a little outside of the
// surface, so that their area is that of the surface, and with it the power of a light. Nothing is further
// off the surface than 0.5 % of the largest radius (of a sphere 0.8 %). Fronts are where the corners run
// counterclockwise.

using Corners = std::vector<glm::dvec3>;

/// The side of a truncated cone between two circles, without its ends; a radius of 0 makes a tip. The front
/// is outside. The circles differ in their centres, and one has a radius.
[[nodiscard]] std::vector<Corners> cone_faces(const glm::dvec3& centre0, const glm::dvec3& centre1,
                                              double radius0, double radius1);

/// The ring between two radii, of which the greater is above 0; a disk is one face. The front is where
/// `normal`, of any length, points.
[[nodiscard]] std::vector<Corners> ring_faces(const glm::dvec3& centre, const glm::dvec3& normal,
                                              double radius0, double radius1);

/// A sphere in 16 bands. The front is outside.
[[nodiscard]] std::vector<Corners> sphere_faces(const glm::dvec3& centre, double radius);

}  // namespace fluxel
