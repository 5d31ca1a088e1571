#include "formfactor/seen_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

namespace {

/// Of a spherical triangle (van Oosterom & Strackee 1983) [sr].
double solid_angle_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
  return 2 * std::atan2(volume, 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

/// The unit vector from a towards x, perpendicular to a; 0 where they are parallel.
glm::dvec3 towards(const glm::dvec3& a, const glm::dvec3& x) {
  const glm::dvec3 across = x - glm::dot(a, x) * a;
  const double length = glm::length(across);
  return length > 0 ? across / length : glm::dvec3(0);
}

/// The direction that is turned from a towards x until the cosine of the angle is this.
glm::dvec3 turned(const glm::dvec3& a, const glm::dvec3& x, double cosine) {
  return cosine * a + std::sqrt(std::max(0.0, 1 - cosine * cosine)) * towards(a, x);
}

/// A direction within a spherical triangle: u chooses the part of its solid angle that lies between the edge
/// ab and an arc from b to the edge ac, v the place on the arc.
glm::dvec3 direction_within(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double solid_angle,
                            double u, double v) {
  const double cos_alpha = std::clamp(glm::dot(towards(a, b), towards(a, c)), -1.0, 1.0);
  const double sin_alpha = std::sqrt(1 - cos_alpha * cos_alpha), cos_ab = glm::dot(a, b);
  const double sine = std::sin(u * solid_angle), cosine_of = std::cos(u * solid_angle);
  const double s = sine * cos_alpha - cosine_of * sin_alpha, t = cosine_of * cos_alpha + sine * sin_alpha;
  const double x = t - cos_alpha, y = s + sin_alpha * cos_ab;
  const double along = (y * t - x * s) * cos_alpha - y, whole = (y * s + x * t) * sin_alpha;
  // Of a triangle too narrow for its angles to be told, the edge ac.
  const double cos_ac = glm::dot(a, c);
  const double cosine = std::abs(whole) > 0 ? std::clamp(along / whole, cos_ac, 1.0) : 1 - u * (1 - cos_ac);
  const glm::dvec3 end = turned(a, c, cosine);
  return turned(b, end, 1 - v * (1 - glm::dot(end, b)));
}

}  // namespace

SeenPolygon::SeenPolygon(const glm::dvec3& from, PolygonView polygon, const glm::dvec3& normal)
    : from_(from), normal_(normal), height_(glm::dot(normal, polygon[0] - from)) {
  for (const glm::dvec3& corner : polygon) {
    const glm::dvec3 d = corner - from;
    const double distance = glm::length(d);
    farthest_ = std::max(farthest_, distance);
    // A corner where the point itself lies is seen in no direction.
    directions_.push_back(distance > 0 ? d / distance : glm::dvec3(0));
  }
  double sum = 0;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    sum += solid_angle_of(directions_[0], directions_[k], directions_[k + 1]);
    ends_.push_back(sum);
  }
}

glm::dvec3 SeenPolygon::point(double u, double v) const {
  const double wanted = u * solid_angle();
  std::size_t k = 0;
  while (k + 1 < ends_.size() && wanted >= ends_[k]) ++k;
  const double start = k > 0 ? ends_[k - 1] : 0, size = ends_[k] - start;
  const double within = size > 0 ? std::min(1.0, (wanted - start) / size) : 0.5;
  const glm::dvec3 direction =
      direction_within(directions_[0], directions_[k + 1], directions_[k + 2], size, within, v);
  // Rounding may have turned it past the edge, and past the horizon.
  const double distance = height_ / glm::dot(normal_, direction);
  return from_ + (distance >= 0 && distance <= farthest_ ? distance : farthest_) * direction;
}

}  // namespace fluxel
