#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fluxel {

/// Indices of three corners of a polygon, in the polygon's orientation.
using CornerTriple = std::array<std::size_t, 3>;

/// The vector area of a closed polygon [m2]: along the normal of its mean plane by the right-hand rule, as
/// long as the area of the polygon's shadow on that plane. (Newell's method, as in Sutherland, Sproull and
/// Schumacker, A characterization of ten hidden-surface algorithms, 1974.)
[[nodiscard]] glm::dvec3 vector_area(std::span<const glm::dvec3> corners);

/// A polygon cut into triangles.
struct Triangulation {
  std::vector<CornerTriple> triangles;  ///< n - 2 at most; those without an area are left out
  bool simple = true;                   ///< false: the outline crosses itself, the triangles may overlap
};

/// Cuts a simple polygon, concave or convex, along its diagonals, seen along its vector area, which is not
/// zero: ear clipping (Meisters, Polygons have ears, 1975). A convex polygon becomes the fan around its first
/// corner. Takes the square of the number of corners, in the worst case the cube.
[[nodiscard]] Triangulation triangulate(std::span<const glm::dvec3> corners);

}  // namespace fluxel
