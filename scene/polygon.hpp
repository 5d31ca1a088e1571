#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/element.hpp"

namespace fluxel {

/// The corners of a flat convex polygon, counter-clockwise about its normal [m].
using Polygon = std::vector<glm::dvec3>;
using PolygonView = std::span<const glm::dvec3>;

struct Segment {
  glm::dvec3 from{0}, to{0};
};

struct Plane {
  glm::dvec3 point{0};
  glm::dvec3 normal{0};  ///< unit

  [[nodiscard]] double distance(const glm::dvec3& x) const;  ///< positive on the normal's side [m]
};

[[nodiscard]] inline PolygonView corners(const Outline<glm::dvec3>& outline) {
  return {outline.corner.data(), outline.corners};
}

/// Along the normal, as long as the area [m2].
[[nodiscard]] glm::dvec3 area_vector(PolygonView polygon);
[[nodiscard]] double area(PolygonView polygon);
[[nodiscard]] glm::dvec3 centroid(PolygonView polygon);  ///< of the area

/// The plane through an edge, upright on the polygon, its normal pointing into the polygon. `normal` is the
/// polygon's. An edge of no length gives a plane of no normal, from which every distance is 0.
[[nodiscard]] Plane edge_plane(PolygonView polygon, std::size_t edge, const glm::dvec3& normal);

/// Of a point of space from a convex polygon [m2].
[[nodiscard]] double squared_distance(const glm::dvec3& point, PolygonView polygon, const glm::dvec3& normal);

/// The least distance between two parallel lines in the plane with the polygon between them [m]; a convex
/// polygon attains it along one of its edges.
[[nodiscard]] double width(PolygonView polygon, const glm::dvec3& normal);

/// True where two convex polygons of one plane share a region wider than `tolerance`.
[[nodiscard]] bool share_area(PolygonView a, PolygonView b, const glm::dvec3& normal_a,
                              const glm::dvec3& normal_b, double tolerance);

/// The part of a segment deeper inside a convex polygon than `inset` from each of its edges.
[[nodiscard]] std::optional<Segment> clip(const Segment& segment, PolygonView polygon,
                                          const glm::dvec3& normal, double inset);

struct Halves {
  Polygon front, back;  ///< one is empty where the plane does not cut
};

/// Cuts a convex polygon by a plane. Corners within `tolerance` of the plane are taken as corners of the cut,
/// so that no edge shorter than that arises; the halves always add up to the polygon, and where one of them
/// would be thinner than `tolerance` nothing is cut.
[[nodiscard]] Halves split(const Polygon& polygon, const Plane& plane, double tolerance);

/// Takes a convex cutter of the same plane from a convex polygon. The parts that remain are convex; `covered`
/// grows by the area taken [m2].
[[nodiscard]] std::vector<Polygon> difference(const Polygon& polygon, PolygonView cutter,
                                              const glm::dvec3& cutter_normal, double tolerance,
                                              double& covered);

/// A convex polygon as triangles and parallelograms: one parallelogram where its corners are that within
/// `rounding` [m], else the triangulation whose worst triangle is best shaped (height over longest edge), by
/// dynamic programming over the diagonals (Klincsek 1980).
[[nodiscard]] std::vector<Outline<glm::dvec3>> to_outlines(const Polygon& polygon, double rounding);

}  // namespace fluxel
