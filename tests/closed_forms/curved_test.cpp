#include "tests/closed_forms/curved.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/closed_forms/points.hpp"
#include "tests/closed_forms/quadrature.hpp"

namespace fluxel::closed_forms {
namespace {

using std::numbers::pi;

TEST(Curved, DiscCheckValues) {
  EXPECT_NEAR(coaxial_discs(1, 1, 1), (3 - std::sqrt(5)) / 2, 1e-15);
  EXPECT_NEAR(coaxial_discs(1, 2, 1), 0.763932022500210, 1e-15);
  EXPECT_NEAR(coaxial_discs(2, 1, 1), 0.190983005625053, 1e-15);
  EXPECT_NEAR(coaxial_discs(1, 1, 10), 0.0098048640721517, 1e-16);
}

TEST(Curved, DiscsAgainstQuadrature) {
  const double r1 = 0.7, r2 = 1.2, gap = 0.9;
  const auto ring_to_disc = [&](double r) {
    const Rectangle disc{0, r2, 0, pi};  // half of it, radius and angle
    return 2 * r * 2 * integrate<30>(disc, [&](double s, double angle) {
             return s * kernel({r, 0, 0}, kZ, {s * std::cos(angle), s * std::sin(angle), gap}, -kZ);
           });
  };
  EXPECT_NEAR(coaxial_discs(r1, r2, gap), integrate(0, r1, ring_to_disc) / (r1 * r1), 1e-12);
}

TEST(Curved, DiscLimits) {
  EXPECT_NEAR(coaxial_discs(1e-9, 2, 3), point_to_coaxial_disc(2, 3), 1e-15);
  EXPECT_NEAR(coaxial_discs(1, 1, 1e6) * 1e12, 1, 1e-11);
  EXPECT_NEAR(coaxial_discs(1, 1, 1e-6), 1, 2e-6);
  EXPECT_NEAR(1.5 * 1.5 * coaxial_discs(1.5, 0.1, 2), 0.01 * coaxial_discs(0.1, 1.5, 2), 1e-16);
}

TEST(Curved, SphereCheckValues) {
  EXPECT_NEAR(sphere_to_rectangle(1, 1, 1), 1.0 / 24, 1e-16);
  EXPECT_NEAR(sphere_to_coaxial_disc(1, 1), 0.146446609406726, 1e-15);
}

// A sphere seen from distance d fills r^2/d^2 of a piece that faces it: integrated over the receiver it is
// F21.
TEST(Curved, SpheresAgainstQuadrature) {
  const double radius = 0.5, height = 1.1, sphere_area = 4 * pi * radius * radius;
  const auto irradiance = [&](double x, double y) {
    const double square = x * x + y * y + height * height;
    return radius * radius / square * height / std::sqrt(square);
  };
  EXPECT_NEAR(sphere_to_rectangle(0.8, 1.4, height),
              integrate<30>({0, 0.8, 0, 1.4}, irradiance) / sphere_area, 1e-14);
  const auto ring = [&](double r) { return 2 * pi * r * irradiance(r, 0); };
  EXPECT_NEAR(sphere_to_coaxial_disc(1.3, height), integrate<30>(0, 1.3, ring) / sphere_area, 1e-14);
}

TEST(Curved, SphereLimits) {
  EXPECT_NEAR(sphere_to_rectangle(1e9, 1e9, 1), 1.0 / 8, 1e-9);  // a quarter of a half space
  EXPECT_NEAR(sphere_to_coaxial_disc(1e9, 1), 1.0 / 2, 1e-9);
  EXPECT_NEAR(sphere_to_coaxial_disc(1e-6, 1) / 1e-12, 1.0 / 4, 1e-12);
}

// Both integrals over the heights of two parallel lines are closed: 2 int_0^L (L - h)/(d^2 + h^2)^2 dh = L
// atan(L/d)/d^3 at distance d. What remains is one integral over the angle between the lines, in pieces
// because it starts steeply in short cylinders.
NestedFactors cylinders_by_quadrature(double r1, double r2, double length) {
  const double horizon = std::acos(r1 / r2);
  const auto between = [&](double angle) {
    const double c = std::cos(angle), d = std::sqrt(r1 * r1 + r2 * r2 - 2 * r1 * r2 * c);
    return (r2 * c - r1) * (r2 - r1 * c) * std::atan(length / d) / (pi * d * d * d);
  };
  const auto within = [&](double angle) {
    const double d = 2 * r2 * std::sin(angle / 2), depth = d * d / (2 * r2);  // r2 (1 - cos angle)
    return depth * depth * std::atan(length / d) / (pi * d * d * d);
  };
  const auto in_pieces = [](double end, const auto& function) {
    double sum = 0;
    for (int i = 0; i < 8; ++i) sum += integrate<30>(i * end / 8, (i + 1) * end / 8, function);
    return sum;
  };
  return {.outer_to_inner = 2 * r1 * in_pieces(horizon, between),
          .outer_to_outer = 2 * r2 * in_pieces(2 * horizon, within)};
}

TEST(Curved, CylindersAgainstQuadrature) {
  for (const double ratio : {1.1, 2.0, 5.0}) {
    for (const double length : {0.5, 1.0, 4.0, 20.0}) {
      const NestedFactors expected = cylinders_by_quadrature(1, ratio, length);
      const NestedFactors found = finite_coaxial_cylinders(1, ratio, length);
      EXPECT_NEAR(found.outer_to_inner, expected.outer_to_inner, 1e-12) << ratio << ' ' << length;
      EXPECT_NEAR(found.outer_to_outer, expected.outer_to_outer, 1e-12) << ratio << ' ' << length;
    }
  }
}

TEST(Curved, LongCylinders) {
  const NestedFactors infinite = infinite_coaxial_cylinders(1, 2),
                      finite = finite_coaxial_cylinders(1, 2, 1e4);
  EXPECT_NEAR(finite.outer_to_inner, infinite.outer_to_inner, 1e-4);
  EXPECT_NEAR(finite.outer_to_outer, infinite.outer_to_outer, 1e-4);
  EXPECT_DOUBLE_EQ(infinite.outer_to_inner, 0.5);
}

TEST(Curved, ShellsClose) {
  EXPECT_DOUBLE_EQ(concentric_spheres(1, 3).outer_to_inner, 1.0 / 9);
  EXPECT_DOUBLE_EQ(concentric_spheres(1, 3).outer_to_outer, 8.0 / 9);
  EXPECT_DOUBLE_EQ(convex_body_in_shell(6, 54).outer_to_inner, 1.0 / 9);
}

}  // namespace
}  // namespace fluxel::closed_forms
