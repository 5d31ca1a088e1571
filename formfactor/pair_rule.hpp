#pragma once

#include "core/choices.hpp"
#include "core/element.hpp"
#include "core/second_moments.hpp"

namespace fluxel {

/// What the solver's vector kernel evaluates for every pair that sees each other. With r the distance of the
/// centroids and c the cosines:
///
///   point    F_ij = A_j c_i c_j / (pi r^2)                   (Debelov & Sattarov, eq. 6, with its 1/pi)
///   disc     F_ij = A_j c_i c_j / (pi r^2 + max(A_i, A_j))   (Wallace, Elmquist & Haines 1989, eq. 6)
///   moments  the mean of the kernel k = c c / (pi r^2) over both elements to second order: k at the
///   centroids,
///            plus half of its second derivatives times the covariances of both elements' points. Its
///            relative error falls with the fourth power of size over distance, the others' with the second.
///
/// Eq. 6 as printed in the first source lacks the 1/pi. In the second the source's area became the larger of
/// both, so that A_i F_ij = A_j F_ji stays exact; both F are then at most 1. In moments r^2 is kept above
/// kNearestSquares times the variances, so that what near pairs get (to be replaced) stays bounded.
enum class PairRule { point, disc, moments };

inline constexpr double kNearestSquares = 3;

/// What the rules know of a flat shape.
struct FlatShape {
  glm::dvec3 centroid{0};
  glm::dvec3 normal{0};  ///< unit
  double area = 0;       ///< [m2]
  SecondMoments moments;
};

[[nodiscard]] FlatShape flat_shape(const Element& element);

/// The largest relative error of PairRule::point, measured by the kernel with both cosines 1, of elements
/// with these variances [m2] at a distance of r or more.
[[nodiscard]] constexpr double point_error(double variance_i, double variance_j, double r2) {
  return 2 * (variance_i + variance_j) / r2;
}

/// What the kernel evaluates, before corrections: `rule`, but between tiles so far apart that point_error
/// stays within `far_error` PairRule::point instead of moments, at a third of the cost.
struct KernelRule {
  PairRule rule = PairRule::moments;
  double far_error = 0;

  KernelRule(PairRule of_pairs, double error = 0) : rule(of_pairs), far_error(error) {}
};

[[nodiscard]] KernelRule kernel_rule(const FormFactorOptions& options);

/// F_ij of two shapes that see each other, in double precision: the plain statement of the kernel. The
/// cosines count by magnitude: which sides face each other is the visibility's knowledge.
[[nodiscard]] double pair_form_factor(PairRule rule, const FlatShape& i, const FlatShape& j);

/// An estimate of the error of both F by PairRule::moments, the larger of |error of F_ij| and |error of
/// F_ji|, for shapes that lie on one side of each other's plane and of which nothing is known but size,
/// distance and direction. Near enough to matter it holds within a factor of about six.
[[nodiscard]] double moments_error(const FlatShape& i, const FlatShape& j);

/// An estimate of what both F miss where one shape crosses the other's plane: the moments rule takes the
/// whole shape or nothing, the truth is the part in front. Always too little, so that a row's misses add up.
[[nodiscard]] double crossing_error(const FlatShape& i, const FlatShape& j);

[[nodiscard]] inline double pair_form_factor(PairRule rule, const Element& i, const Element& j) {
  return pair_form_factor(rule, flat_shape(i), flat_shape(j));
}
[[nodiscard]] inline double moments_error(const Element& i, const Element& j) {
  return moments_error(flat_shape(i), flat_shape(j));
}
[[nodiscard]] inline double crossing_error(const Element& i, const Element& j) {
  return crossing_error(flat_shape(i), flat_shape(j));
}

}  // namespace fluxel
