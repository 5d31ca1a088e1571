#include "formfactor/pair_rule.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel {

namespace {

/// The mean squared distance of an element's points from its centroid [m2].
double variance(const Element& element) {
  const glm::dvec3 elongation(element.elongation);
  return 2 * static_cast<double>(element.spread) + glm::dot(elongation, elongation);
}

/// Half of the second derivatives of the kernel times the covariance of the element on which `height` stands,
/// over height / r^2. `across` is the other element's reversed normal times this one's normal.
double second_order(const Element& element, const glm::dvec3& d, const glm::dvec3& other_normal,
                    double height, double other_height, double across, double r2) {
  const glm::dvec3 elongation(element.elongation);
  const auto spread = static_cast<double>(element.spread);
  const double along = glm::dot(elongation, d);
  const double mixed = spread * (other_height - across * height) + glm::dot(elongation, other_normal) * along;
  const double square = spread * (glm::dot(d, d) - height * height) + along * along;
  return -4 * mixed + other_height * (12 * square / r2 - 2 * variance(element));
}

}  // namespace

PairRule base_rule(FormFactor method) {
  switch (method) {
    case FormFactor::point:
      return PairRule::point;
    case FormFactor::disc:
    case FormFactor::points:
      return PairRule::disc;
    case FormFactor::adaptive:
      return PairRule::moments;
  }
  return PairRule::moments;
}

double pair_form_factor(PairRule rule, const Element& i, const Element& j) {
  const glm::dvec3 d = glm::dvec3(j.centroid) - glm::dvec3(i.centroid);
  const glm::dvec3 normal_i(i.normal), normal_j = -glm::dvec3(j.normal);
  const double height_i = glm::dot(normal_i, d), height_j = glm::dot(normal_j, d);
  const double area_i = static_cast<double>(i.area), area_j = static_cast<double>(j.area);
  double r2 = glm::dot(d, d);
  if (rule != PairRule::moments) {
    const double bound = rule == PairRule::disc ? std::max(area_i, area_j) : 0.0;
    return area_j * std::abs(height_i * height_j) / (r2 * (std::numbers::pi * r2 + bound));
  }
  r2 = std::max(r2, kNearestSquares * (variance(i) + variance(j)));
  const double across = glm::dot(normal_i, normal_j);
  const double of_i = height_i / r2 * second_order(i, d, normal_j, height_i, height_j, across, r2);
  const double of_j = height_j / r2 * second_order(j, d, normal_i, height_j, height_i, across, r2);
  const double product = height_i * height_j;
  const double kernel = std::copysign(1.0, product) * (product + (of_i + of_j));
  return area_j * std::max(0.0, kernel) / (std::numbers::pi * r2 * r2);
}

double moments_error(const Element& i, const Element& j) {
  // The next term of the expansion for two squares face to face is 5 (variances / r^2)^2; at other angles it
  // is smaller by the cosines, which vary over the elements by their size over r.
  constexpr double kFourthOrder = 5;
  const glm::dvec3 d = glm::dvec3(j.centroid) - glm::dvec3(i.centroid);
  const double r2 = glm::dot(d, d);
  const double variance_i = variance(i), variance_j = variance(j);
  const double size_i = std::sqrt(3 * variance_i), size_j = std::sqrt(3 * variance_j);
  const double height_i = std::abs(glm::dot(glm::dvec3(i.normal), d)) + size_j;
  const double height_j = std::abs(glm::dot(glm::dvec3(j.normal), d)) + size_i;
  const double cosines = std::min(r2, height_i * height_j);
  const double ratio = (variance_i + variance_j) / r2;
  return kFourthOrder * ratio * ratio * static_cast<double>(std::max(i.area, j.area)) * cosines /
         (std::numbers::pi * r2 * r2);
}

}  // namespace fluxel
