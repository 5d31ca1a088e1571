#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "core/element.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

/// An axis-parallel box [m]; it may be flat.
struct Box {
  glm::dvec3 low{0}, high{0};
};

/// The least box around one or more points.
[[nodiscard]] Box bounds(std::span<const glm::dvec3> points);

[[nodiscard]] std::array<glm::dvec3, 8> corners_of(const Box& box);

/// The convex hull of two flat convex polygons or of two axis-parallel boxes as the set of its supporting
/// planes, to tell which patches can stand between them (Haines & Wallace, Shaft culling for efficient
/// ray-traced radiosity, 1991). All facets of the hull are there, so the tests are as sharp as the hull.
///
/// Geometry is taken to be known to `epsilon` [m]. What enters the hull by no more than that does not count
/// as an occluder: a wall that meets the polygons along an edge from outside, lies in the plane of one of
/// them or only touches the hull. A sheet closer than epsilon to a polygon is therefore part of the polygon,
/// and a gap narrower than epsilon is closed. Rounding tilts the planes of small polygons: epsilon should be
/// at least 1e-14 l^2 / w, with l the scene's largest coordinate and w the width of the narrowest polygon
/// [m]. A smaller one is still safe, but some walls that only touch are then called occluders.
class Shaft {
 public:
  static constexpr std::size_t kMaxCorners = 8;  ///< of a polygon

  /// Between two polygons of 3 to 8 corners, of either orientation, which may touch. Each is to lie on one
  /// side of the other's plane; where it does not the shaft is still safe, only wider than the hull. Throws
  /// std::logic_error for another number of corners.
  Shaft(PolygonView a, PolygonView b);

  /// Between everything that lies in two boxes, which may touch or overlap.
  Shaft(const Box& a, const Box& b);

  /// False only where every point of the patch is outside the hull or within epsilon of a plane that supports
  /// it; the segments between the two that meet such a patch do so there.
  [[nodiscard]] bool may_meet(const Outline<glm::dvec3>& patch, double epsilon) const;

  /// False only where this holds for everything in the box.
  [[nodiscard]] bool may_meet(const Box& box, double epsilon) const;

  /// True only where the patch cuts every segment between the two, as cuts_off has it.
  [[nodiscard]] bool blocks(const Outline<glm::dvec3>& patch, double epsilon) const;

  /// Inside are the x with dot(normal, x) > offset.
  struct HalfSpace {
    glm::dvec3 normal;  // unit
    double offset;
  };
  static constexpr std::size_t kMaxPlanes = 2 + 2 * kMaxCorners;  // boxes have up to 6 + 12

  /// The planes that bound the hull, and the corners of the two bodies.
  [[nodiscard]] std::span<const HalfSpace> planes() const { return {plane_.data(), planes_}; }
  [[nodiscard]] std::span<const glm::dvec3> corners() const { return {corner_.data(), corners_}; }

 private:
  void add_supporting_plane(const glm::dvec3& direction);
  void add_planes_of(PolygonView from, PolygonView to);

  std::array<glm::dvec3, 2 * kMaxCorners> corner_;  // of the first body, then of the second
  std::array<HalfSpace, kMaxPlanes> plane_;
  std::size_t corners_ = 0;
  std::size_t first_corners_ = 0;  // of the first body
  std::size_t planes_ = 0;
  Box bounds_;
};

}  // namespace fluxel
