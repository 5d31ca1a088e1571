#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace fluxel {

// Round surfaces as polygons: 32 segments around the axis. Corners stand so far outside of the surface that
// areas agree, and with them the power of lights. Nothing is further off the surface than 0.4 % of its
// greatest radius (sphere: 0.6 %). Fronts are where the corners run counterclockwise.

/// Whether a ring closes an end of what is round: its corners are then those of the ring, and its area 0.2 %
/// too large.
enum class RoundEnds { open, closed };

using Corners = std::vector<glm::dvec3>;

/// The side of a truncated cone between two circles, without its ends (see RoundEnds); a radius of 0 makes a
/// tip. The front is outside. The circles differ in their centres, and one has a radius.
[[nodiscard]] std::vector<Corners> cone_faces(const glm::dvec3& centre0, const glm::dvec3& centre1,
                                              double radius0, double radius1,
                                              RoundEnds ends = RoundEnds::open);

/// The ring between two radii, of which the greater is above 0; a disk is one face. The front is where
/// `normal`, of any length, points.
[[nodiscard]] std::vector<Corners> ring_faces(const glm::dvec3& centre, const glm::dvec3& normal,
                                              double radius0, double radius1);

/// A sphere in 16 bands. The front is outside.
[[nodiscard]] std::vector<Corners> sphere_faces(const glm::dvec3& centre, double radius);

}  // namespace fluxel
