#include "core/second_moments.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

double SecondMoments::trace() const { return 2 * minor_variance + glm::dot(elongation, elongation); }

SecondMoments second_moments(const Outline<glm::dvec3>& outline) {
  // In a frame (along, across) of the plane; the sums are those of a triangle's corners about its centroid,
  // or of a parallelogram's two edges, each over 12.
  const bool triangle = outline.corners == 3;
  const glm::dvec3 edge = outline.corner[1] - outline.corner[0];
  const glm::dvec3 other = outline.corner[triangle ? 2 : 3] - outline.corner[0];
  const double length = glm::length(edge);
  if (length == 0) return {};
  const glm::dvec3 along = edge / length;
  const glm::dvec3 upright = other - glm::dot(other, along) * along;
  const double height = glm::length(upright);
  const glm::dvec3 across = height > 0 ? upright / height : glm::dvec3(0);
  const double slant = glm::dot(other, along);
  double xx, xy, yy;
  if (triangle) {
    xx = (length * length - length * slant + slant * slant) / 18;
    xy = height * (2 * slant - length) / 36;
    yy = height * height / 18;
  } else {
    xx = (length * length + slant * slant) / 12;
    xy = slant * height / 12;
    yy = height * height / 12;
  }
  const double middle = (xx + yy) / 2;
  const double radius = std::hypot((xx - yy) / 2, xy);
  const double angle = std::atan2(xy, (xx - yy) / 2) / 2;
  const glm::dvec3 axis = std::cos(angle) * along + std::sin(angle) * across;
  return {std::max(0.0, middle - radius), std::sqrt(2 * radius) * axis};
}

}  // namespace fluxel
