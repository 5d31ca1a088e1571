#include "formfactor/pair_rule.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel {

namespace {

/// With d from i to j, heights p = n_i . d and q = n_j . d, g = n_i . n_j and covariances m (1 - n n^T) + e
/// e^T, the second-order term of p q / r^4, over 1 / r^6, is
///   p q (c + 3/r^2 (a_i^2 + a_j^2 - k)) + g k - (p a_i b_i + q a_j b_j),   k = 4 m_i p^2 + 4 m_j q^2,
///   a = 2 e . d, b_i = 2 e_i . n_j (and likewise b_j), c = 4 (m_i + m_j) - 2 (|e_i|^2 + |e_j|^2).
double second_order(const Element& i, const Element& j, const glm::dvec3& d, double p, double q, double r2) {
  const glm::dvec3 normal_i(i.normal), normal_j(j.normal);
  const glm::dvec3 elongation_i = 2.0 * glm::dvec3(i.elongation),
                   elongation_j = 2.0 * glm::dvec3(j.elongation);
  const double spread_i = 4 * static_cast<double>(i.spread), spread_j = 4 * static_cast<double>(j.spread);
  const double along_i = glm::dot(elongation_i, d), along_j = glm::dot(elongation_j, d);
  const double k = spread_i * p * p + spread_j * q * q;
  const double c = spread_i + spread_j -
                   0.5 * (glm::dot(elongation_i, elongation_i) + glm::dot(elongation_j, elongation_j));
  return p * q * (c + 3 / r2 * (along_i * along_i + along_j * along_j - k)) +
         glm::dot(normal_i, normal_j) * k -
         (p * along_i * glm::dot(elongation_i, normal_j) + q * along_j * glm::dot(elongation_j, normal_i));
}

}  // namespace

double variance(const Element& element) {
  const glm::dvec3 elongation(element.elongation);
  return 2 * static_cast<double>(element.spread) + glm::dot(elongation, elongation);
}

KernelRule kernel_rule(const FormFactorOptions& options) {
  // The cosines take off most of what point_error allows, and errors of both signs meet in a row.
  constexpr double kFarShare = 0.5;
  switch (options.rule) {
    case FormFactor::point:
      return PairRule::point;
    case FormFactor::disc:
    case FormFactor::points:
      return PairRule::disc;
    case FormFactor::adaptive:
      return {PairRule::moments, kFarShare * options.tolerance};
  }
  return PairRule::moments;
}

double pair_form_factor(PairRule rule, const Element& i, const Element& j) {
  const glm::dvec3 d = glm::dvec3(j.centroid) - glm::dvec3(i.centroid);
  const glm::dvec3 normal_i(i.normal), normal_j(j.normal);
  const double height_i = glm::dot(normal_i, d), height_j = glm::dot(normal_j, d);
  const double area_i = static_cast<double>(i.area), area_j = static_cast<double>(j.area);
  double r2 = glm::dot(d, d);
  if (rule != PairRule::moments) {
    const double bound = rule == PairRule::disc ? std::max(area_i, area_j) : 0.0;
    return area_j * std::abs(height_i * height_j) / (r2 * (std::numbers::pi * r2 + bound));
  }
  r2 = std::max(r2, kNearestSquares * (variance(i) + variance(j)));
  // Odd in both normals: which way they point decides the sign alone.
  const double product = height_i * height_j;
  const double kernel =
      std::copysign(1.0, product) * (product + second_order(i, j, d, height_i, height_j, r2) / r2);
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
