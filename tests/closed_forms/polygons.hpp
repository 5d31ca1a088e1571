#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fluxel::closed_forms {

/// Corners of a plane polygon, counter-clockwise about the normal of the face that sends and receives.
using Polygon = std::vector<glm::dvec3>;

/// Half the sum of the corners' cross products: the unit normal times the area.
[[nodiscard]] glm::dvec3 vector_area(const Polygon& polygon);
[[nodiscard]] double area(const Polygon& polygon);
[[nodiscard]] double area(std::span<const Polygon> polygons);

/// The part of a polygon on the side of the plane through `point` that `normal` points to; empty where
/// nothing is.
[[nodiscard]] Polygon clip(const Polygon& polygon, const glm::dvec3& point, const glm::dvec3& normal);

/// Fraction of the power of a small piece dA at `point` facing `normal` (unit) that reaches a polygon, of
/// whichever face: Lambert's sum of edge angles (1760; Baum, Rushmeier & Winget 1989, eq. 9), after a cut at
/// dA's horizon. Absolute error about 1e-16 for each edge; `point` does not lie on the polygon.
[[nodiscard]] double point_to_polygon(const glm::dvec3& point, const glm::dvec3& normal,
                                      const Polygon& polygon);

/// Exchange area A1 F12 = A2 F21 of the faces of two plane polygons that nothing stands between. What lies
/// behind the other's plane is cut off first. By Stokes' theorem (Sparrow 1963; Schroeder & Hanrahan 1993
/// have its closed form)
///   A1 F12 = 1/(2 pi) sum over edges i of 1, j of 2 of (u_i . v_j) int int ln r ds dt,
/// u and v unit vectors along the edges. The inner integral is closed, the outer one a Gauss rule on pieces
/// that shrink towards edge j, so that common edges and corners need no exception. Absolute error about 1e-15
/// |ln r| (perimeter 1)(perimeter 2): keep lengths near 1. Corners of one do not lie inside edges of the
/// other.
[[nodiscard]] double exchange_area(const Polygon& polygon_1, const Polygon& polygon_2);

/// The same between groups, as if no polygon stood between two others.
[[nodiscard]] double exchange_area(std::span<const Polygon> group_1, std::span<const Polygon> group_2);

/// F12 of two polygons: exchange_area by the area of the first.
[[nodiscard]] double polygon_to_polygon(const Polygon& sender, const Polygon& receiver);

}  // namespace fluxel::closed_forms
