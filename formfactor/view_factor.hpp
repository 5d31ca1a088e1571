#pragma once

#include <boost/container/small_vector.hpp>
#include <glm/vec3.hpp>

#include "scene/polygon.hpp"

namespace fluxel {

/// A convex polygon of a few corners, without a visit to the heap.
using SmallPolygon = boost::container::small_vector<glm::dvec3, 8>;

[[nodiscard]] inline PolygonView corners(const SmallPolygon& polygon) {
  return {polygon.data(), polygon.size()};
}

/// The part of a convex polygon in front of a plane; empty where nothing of it has an area there. Corners
/// within `tolerance` [m] of the plane lie in it.
[[nodiscard]] SmallPolygon clip_to_front(PolygonView polygon, const Plane& plane, double tolerance = 0);

/// The configuration factor of a surface element at `point` with unit normal `normal` towards a flat polygon:
/// the fraction of its diffuse power that reaches the polygon, nothing standing between, whichever side of
/// the polygon faces the point; 0..1. Lambert's contour formula (Photometria, 1760; Baum, Rushmeier & Winget
/// 1989, eq. 8), the polygon clipped to the horizon.
[[nodiscard]] double point_to_polygon(const glm::dvec3& point, const glm::dvec3& normal, PolygonView polygon);

/// How many Gauss points a stretch of an edge gets. The largest errors of G over the smaller area, found on
/// 180,000 random pairs of triangles and parallelograms of sizes to 1:100, free, touching and cut by the
/// other's plane; near are those whose centres are less than twice the sum of their radii apart:
///
///                                                              coarse          fine
///   near, square on the longest diagonal up to 8 areas         9e-5            3e-8
///     99 of 100 of them                                        2e-5            4e-10
///   near, slivers, up to 256 areas                             1.1e-3          2.3e-7
///   further away                                               2e-12           2e-12 (rounding)
///
/// Relative to G they are larger where polygons hardly see each other.
enum class ContourPoints { coarse = 7, fine = 25 };

/// The exchange area G = A_P F_PQ = A_Q F_QP [m2] of two flat polygons, counter-clockwise about normals that
/// face each other, neither of which crosses the other's plane (see clip_to_front), nothing standing between.
/// Sparrow's double contour integral of ln r (1963; Schroeder & Hanrahan 1993 give the closed form of the
/// same value): the inner integral is closed, the outer one Gauss-Legendre, graded towards the places where a
/// corner of Q comes near an edge of P or their edges pass each other. Polygons may share edges and corners.
[[nodiscard]] double exchange_area_by_contour(PolygonView P, PolygonView Q, ContourPoints points);

}  // namespace fluxel
