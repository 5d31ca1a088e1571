#include "hierarchy/solid_angle.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

namespace {

/// The part of x perpendicular to the unit vector n, as a unit vector.
glm::dvec3 perpendicular(const glm::dvec3& x, const glm::dvec3& n) {
  const glm::dvec3 part = x - glm::dot(x, n) * n;
  const double length = glm::length(part);
  return length > 0 ? part / length : glm::dvec3(0);
}

double root_of_rest(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

}  // namespace

SeenFace::Triangle::Triangle(const glm::dvec3& first, const glm::dvec3& second, const glm::dvec3& third)
    : a(first), b(second), c(third) {
  const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
  solid_angle = 2 * std::atan2(volume, 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

glm::dvec3 SeenFace::Triangle::draw(double u, double v) const {
  // The angle at a, between the arcs to b and to c.
  const glm::dvec3 to_b = perpendicular(b, a), to_c = perpendicular(c, a);
  const double cos_a = std::clamp(glm::dot(to_b, to_c), -1.0, 1.0), sin_a = root_of_rest(cos_a);
  // The point on the arc from a to c up to which u of the triangle lies.
  const double alpha = std::acos(cos_a), part = u * solid_angle;
  const double s = std::sin(part - alpha), t = std::cos(part - alpha);
  const double p = t - cos_a, q = s + sin_a * glm::dot(a, b);
  const double below = (q * s + p * t) * sin_a;
  const double cosine = below != 0 ? std::clamp(((q * t - p * s) * cos_a - q) / below, -1.0, 1.0) : 1.0;
  const glm::dvec3 end = cosine * a + root_of_rest(cosine) * to_c;
  const double z = 1 - v * (1 - glm::dot(end, b));
  return z * b + root_of_rest(z) * perpendicular(end, b);
}

SeenFace::SeenFace(const Outline<glm::dvec3>& outline, const glm::dvec3& from)
    : from_(from), corner_(outline.corner[0]) {
  const auto direction = [&](std::size_t k) {
    const glm::dvec3 way = outline.corner[k] - from;
    const double length = glm::length(way);
    return length > 0 ? way / length : glm::dvec3(0);
  };
  normal_ = glm::cross(outline.corner[1] - corner_, outline.corner[2] - corner_);
  first_ = Triangle(direction(0), direction(1), direction(2));
  if (outline.corners == 4) second_ = Triangle(direction(0), direction(2), direction(3));
}

glm::dvec3 SeenFace::draw(double u, double v) const {
  const double of_first = first_.solid_angle / solid_angle();
  const glm::dvec3 direction =
      u < of_first ? first_.draw(u / of_first, v) : second_.draw((u - of_first) / (1 - of_first), v);
  const double rise = glm::dot(direction, normal_);
  return rise != 0 ? from_ + glm::dot(corner_ - from_, normal_) / rise * direction : corner_;
}

}  // namespace fluxel
