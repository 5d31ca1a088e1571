#pragma once

#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "tests/closed_forms/polygons.hpp"
#include "tests/closed_forms/rectangles.hpp"

namespace fluxel::closed_forms {

/// Polygons of standard shapes. Faces point as said; `reversed` turns them.

[[nodiscard]] Polygon reversed(Polygon polygon);
[[nodiscard]] std::vector<Polygon> reversed(std::vector<Polygon> polygons);

/// [x] x [y] at height z, facing +z.
[[nodiscard]] Polygon horizontal(const Rectangle& rectangle, double z);

/// [z] x [y] in the plane at x, facing +x.
[[nodiscard]] Polygon facing_x(const Rectangle& rectangle, double x);

/// Two unit squares with a common edge on the y axis that enclose `angle` [rad] and face each other; the
/// first in z = 0.
[[nodiscard]] std::pair<Polygon, Polygon> hinged_squares(double angle);

/// An axis-parallel box's six faces, outwards: bottom, top, then the sides at low y, high y, low x, high x.
[[nodiscard]] std::vector<Polygon> box(const glm::dvec3& low, const glm::dvec3& high);
[[nodiscard]] std::vector<Polygon> cube(const glm::dvec3& centre, double side);

/// A regular polygon about the z axis at height z, facing +z, the first corner at y = 0.
[[nodiscard]] Polygon regular_polygon(int corners, double circumradius, double z);

/// The regular polygon that has a disc's area: its edge swings about the disc's, so that the view factor's
/// error is of second order in the swing, corners^-4.
[[nodiscard]] Polygon disc(int corners, double radius, double z);

/// A sphere's area in 20 frequency^2 triangles, outwards: an icosahedron, its faces divided and pushed to a
/// sphere. Convex; its corners lie a little outside the sphere.
[[nodiscard]] std::vector<Polygon> geodesic_sphere(int frequency, const glm::dvec3& centre, double radius);

}  // namespace fluxel::closed_forms
