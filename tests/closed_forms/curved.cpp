#include "tests/closed_forms/curved.hpp"

#include <cmath>
#include <numbers>

namespace fluxel::closed_forms {

namespace {
using std::numbers::pi;
}

double coaxial_discs(double radius_1, double radius_2, double gap) {
  const double R1 = radius_1 / gap, R2 = radius_2 / gap;
  // The textbook's (X - sqrt(X^2 - 4 (R2/R1)^2)) / 2 times its conjugate, and the root's two factors apart.
  const double root = std::hypot(R1 - R2, 1) * std::hypot(R1 + R2, 1);
  return 2 * R2 * R2 / (R1 * R1 + R2 * R2 + 1 + root);
}

double sphere_to_rectangle(double length_1, double length_2, double centre_height) {
  const double a = length_1 / centre_height, b = length_2 / centre_height;
  return std::atan(a * b / std::sqrt(1 + a * a + b * b)) / (4 * pi);
}

double sphere_to_coaxial_disc(double disc_radius, double centre_height) {
  const double R = disc_radius / centre_height, slant = std::hypot(1, R);
  return R * R / (2 * slant * (slant + 1));
}

NestedFactors concentric_spheres(double inner_radius, double outer_radius) {
  return convex_body_in_shell(inner_radius * inner_radius, outer_radius * outer_radius);
}

NestedFactors infinite_coaxial_cylinders(double inner_radius, double outer_radius) {
  return convex_body_in_shell(inner_radius, outer_radius);
}

NestedFactors finite_coaxial_cylinders(double inner_radius, double outer_radius, double length) {
  const double X = outer_radius / inner_radius, Y = length / inner_radius;
  const double A = X * X + Y * Y - 1, B = Y * Y - X * X + 1;
  const double gap = 4 * (X * X - 1), q = std::sqrt(4 * X * X + Y * Y) / Y;

  NestedFactors factors;
  const double ends =
      std::sqrt((A + 2) * (A + 2) - 4 * X * X) * std::acos(B / (X * A)) + B * std::asin(1 / X) - pi * A / 2;
  factors.outer_to_inner = (1 - (std::acos(B / A) - ends / (2 * Y)) / pi) / X;

  const double along = std::asin((gap + Y * Y / (X * X) * (X * X - 2)) / (Y * Y + gap));
  factors.outer_to_outer =
      1 - 1 / X + 2 / (pi * X) * std::atan(std::sqrt(gap) / Y) -
      Y / (2 * pi * X) * (q * along - std::asin((X * X - 2) / (X * X)) + pi / 2 * (q - 1));
  return factors;
}

NestedFactors convex_body_in_shell(double body_area, double shell_area) {
  return {.outer_to_inner = body_area / shell_area, .outer_to_outer = (shell_area - body_area) / shell_area};
}

}  // namespace fluxel::closed_forms
