#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "core/element.hpp"

namespace fluxel {

using Outline3 = Outline<glm::dvec3>;

/// A pixel that sees a patch: its number in the raster and where its ray meets the patch's plane [m].
struct PixelPoint {
  std::size_t pixel = 0;
  glm::dvec3 point{0};
};

/// Longer by more than rounding, 1e-9 of the length, which must not decide the mesh: not which of two equal
/// edges is cut, and not whether an edge as long as --max-edge is.
[[nodiscard]] bool is_longer(double length, double other);

/// The two halves of an outline of equal area: a parallelogram across the middle of its longer sides, a
/// triangle by the median to its longest side (Debelov & Sattarov, 3.2; ties to the first side). Corners 1
/// and 2 of the first half are the ends of the dividing line.
[[nodiscard]] std::pair<Outline3, Outline3> bisect(const Outline3& outline);

/// The same across the middle of an edge: of a parallelogram the first or the second (0, 1), of a triangle
/// any.
[[nodiscard]] std::pair<Outline3, Outline3> bisect(const Outline3& outline, std::uint32_t edge);

/// The edge that bisect cuts unless told otherwise.
[[nodiscard]] std::uint32_t edge_to_bisect(const Outline3& outline);

/// Whether a point of the outline's plane belongs to the first of its halves, whatever its distance from
/// them: left of the dividing line, seen against the normal. Points on the line belong to it, whatever
/// rounding has done to them. `twice_area`: the outline's area vector, twice.
[[nodiscard]] bool in_first_half(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& twice_area,
                                 const glm::dvec3& point);

/// Likewise, for many points of one outline.
struct HalfPlane {
  glm::dvec3 across{0};
  double bound = 0;

  [[nodiscard]] bool holds(const glm::dvec3& point) const { return glm::dot(across, point) <= bound; }
};
[[nodiscard]] HalfPlane first_half(const glm::dvec3& from, const glm::dvec3& to,
                                   const glm::dvec3& twice_area);

[[nodiscard]] double longest_edge(const Outline3& outline);  ///< [m]
[[nodiscard]] double diameter(const Outline3& outline);      ///< largest distance of two corners [m]
[[nodiscard]] double area(const Outline3& outline);          ///< [m2]
[[nodiscard]] glm::dvec3 centroid(const Outline3& outline);

/// A leaf of a bisection tree and the pixels that it owns.
struct Leaf {
  Outline3 outline;
  std::vector<std::size_t> pixels;
  int depth = 0;
};

/// Appends the leaves of the tree over `root`, depth first: a node is split while it owns more than
/// `max_pixels` pixels or has an edge longer than `max_edge` (is_longer). Pixels are sorted down the tree by
/// the side of the dividing line that their points lie on, so that each belongs to one leaf. Throws
/// InputError where two pixels' points cannot be told apart in single precision.
void bisect_until(const Outline3& root, std::vector<PixelPoint> pixels, std::size_t max_pixels,
                  double max_edge, std::vector<Leaf>& leaves);

/// Steps after which every node of the tree over `root` is smaller in diameter than `spacing` [m], so that
/// none can own two points that far apart. For a parallelogram of sides a >= b and angle t, with c = |cos t|,
/// a step turns the squared diameter a^2 + b^2 + 2abc into a^2/4 + b^2 + abc, which is at most 5/8 of it
/// because 3 (a^2 - b^2) / 8 + abc/4 >= 0. For a triangle two steps bring it to at most 3/4 (Kearfott 1978,
/// theorem 3.1). Debelov & Sattarov's eq. (7) counts one step for both and compares a circumscribed radius
/// with the pixel's size, which neither separates two rays nor is the distance of two rays near the eye.
[[nodiscard]] int step_bound(const Outline3& root, double spacing);

}  // namespace fluxel
