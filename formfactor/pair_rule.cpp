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
double second_order(const FlatShape& i, const FlatShape& j, const glm::dvec3& d, double p, double q,
                    double r2) {
  const glm::dvec3 elongation_i = 2.0 * i.moments.elongation, elongation_j = 2.0 * j.moments.elongation;
  const double variance4_i = 4 * i.moments.minor_variance, variance4_j = 4 * j.moments.minor_variance;
  const double along_i = glm::dot(elongation_i, d), along_j = glm::dot(elongation_j, d);
  const double k = variance4_i * p * p + variance4_j * q * q;
  const double c = variance4_i + variance4_j -
                   0.5 * (glm::dot(elongation_i, elongation_i) + glm::dot(elongation_j, elongation_j));
  return p * q * (c + 3 / r2 * (along_i * along_i + along_j * along_j - k)) +
         glm::dot(i.normal, j.normal) * k -
         (p * along_i * glm::dot(elongation_i, j.normal) + q * along_j * glm::dot(elongation_j, i.normal));
}

}  // namespace

FlatShape flat_shape(const Element& element) {
  return {glm::dvec3(element.centroid),
          glm::dvec3(element.normal),
          static_cast<double>(element.area),
          {static_cast<double>(element.minor_variance), glm::dvec3(element.elongation)}};
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

double pair_form_factor(PairRule rule, const FlatShape& i, const FlatShape& j) {
  const glm::dvec3 d = j.centroid - i.centroid;
  const double height_i = glm::dot(i.normal, d), height_j = glm::dot(j.normal, d);
  double r2 = glm::dot(d, d);
  if (rule != PairRule::moments) {
    const double bound = rule == PairRule::disc ? std::max(i.area, j.area) : 0.0;
    return j.area * std::abs(height_i * height_j) / (r2 * (std::numbers::pi * r2 + bound));
  }
  r2 = std::max(r2, kNearestSquares * (i.moments.trace() + j.moments.trace()));
  // Odd in both normals: which way they point decides the sign alone.
  const double product = height_i * height_j;
  const double kernel =
      std::copysign(1.0, product) * (product + second_order(i, j, d, height_i, height_j, r2) / r2);
  return j.area * std::max(0.0, kernel) / (std::numbers::pi * r2 * r2);
}

double moments_error(const FlatShape& i, const FlatShape& j) {
  // The next term of the expansion for two squares face to face is 5 (variances / r^2)^2; at other angles it
  // is smaller by the cosines, which vary over the shapes by their size over r.
  constexpr double kFourthOrder = 5;
  const glm::dvec3 d = j.centroid - i.centroid;
  const double r2 = glm::dot(d, d);
  const double variance_i = i.moments.trace(), variance_j = j.moments.trace();
  const double size_i = std::sqrt(3 * variance_i), size_j = std::sqrt(3 * variance_j);
  const double height_i = std::abs(glm::dot(i.normal, d)) + size_j;
  const double height_j = std::abs(glm::dot(j.normal, d)) + size_i;
  const double cosines = std::min(r2, height_i * height_j);
  const double ratio = (variance_i + variance_j) / r2;
  return kFourthOrder * ratio * ratio * std::max(i.area, j.area) * cosines / (std::numbers::pi * r2 * r2);
}

double crossing_error(const FlatShape& i, const FlatShape& j) {
  const glm::dvec3 d = j.centroid - i.centroid;
  const double r2 = glm::dot(d, d);
  // How far the shape reaches from its centroid along a normal; right for a square, wherever it is turned.
  const auto reach = [](const FlatShape& shape, const glm::dvec3& normal) {
    const double across = glm::dot(shape.normal, normal), along = glm::dot(shape.moments.elongation, normal);
    return std::sqrt(6 * (shape.moments.minor_variance * std::max(0.0, 1 - across * across) + along * along));
  };
  const double reach_j = reach(j, i.normal), reach_i = reach(i, j.normal);
  const double height_j = std::abs(glm::dot(i.normal, d)), height_i = std::abs(glm::dot(j.normal, d));
  // Of heights spread evenly from h - reach to h + reach the mean positive one is above h by (reach -
  // h)^2 / 4 reach.
  const auto missed = [](double height, double most) {
    return height < most ? (most - height) * (most - height) / (4 * most) : 0.0;
  };
  const double heights =
      missed(height_j, reach_j) * (height_i + reach_i) + missed(height_i, reach_i) * (height_j + reach_j);
  return std::max(i.area, j.area) * std::min(heights, r2) / (std::numbers::pi * r2 * r2);
}

}  // namespace fluxel
