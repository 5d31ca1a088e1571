#pragma once

#include <boost/container/small_vector.hpp>
#include <glm/vec3.hpp>

#include "scene/polygon.hpp"

namespace fluxel {

/// A flat convex polygon as a point off its plane sees it, to draw its points evenly by their directions: a
/// fan of spherical triangles (Arvo, Stratified sampling of spherical triangles, 1995).
class SeenPolygon {
 public:
  SeenPolygon(const glm::dvec3& from, PolygonView polygon, const glm::dvec3& normal);

  [[nodiscard]] double solid_angle() const { return ends_.back(); }  ///< [sr]

  /// A point of the polygon; from the unit square, u below 1, to the directions area-preserving.
  [[nodiscard]] glm::dvec3 point(double u, double v) const;

 private:
  glm::dvec3 from_, normal_;
  double height_, farthest_ = 0;  // of the plane along the normal, of the corners [m]
  boost::container::small_vector<glm::dvec3, 8> directions_;  // to the corners, unit
  boost::container::small_vector<double, 8> ends_;            // sums of the triangles' solid angles [sr]
};

}  // namespace fluxel
