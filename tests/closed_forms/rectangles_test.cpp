#include "tests/closed_forms/rectangles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/closed_forms/quadrature.hpp"

namespace fluxel::closed_forms {
namespace {

double parallel_by_quadrature(const Rectangle& sender, const Rectangle& receiver, double gap) {
  const auto from_point = [&](double x, double y) {
    return integrate(receiver, [&](double u, double v) { return kernel({x, y, 0}, kZ, {u, v, gap}, -kZ); });
  };
  return integrate(sender, from_point) / area(sender);
}

double perpendicular_by_quadrature(const Rectangle& sender, const Rectangle& receiver) {
  const auto from_point = [&](double x, double y) {
    return integrate(receiver, [&](double z, double v) { return kernel({x, y, 0}, kZ, {0, v, z}, kX); });
  };
  return integrate(sender, from_point) / area(sender);
}

TEST(Rectangles, CheckValues) {
  EXPECT_NEAR(opposed_rectangles(1, 1, 1), 0.199824895698387, 1e-15);
  EXPECT_NEAR(adjacent_rectangles(1, 1, 1), 0.200043776075403, 1e-15);
  EXPECT_NEAR(opposed_rectangles(2, 1, 1), 0.285875384850715, 1e-15);
  EXPECT_NEAR(opposed_rectangles(1, 1, 10), 0.0031620568387576, 1e-16);
  EXPECT_NEAR(adjacent_rectangles(2, 1, 1), 0.116426301397681, 1e-15);
  EXPECT_NEAR(adjacent_rectangles(1, 2, 1), 0.232852602795362, 1e-15);
  EXPECT_NEAR(adjacent_rectangles(0.1, 0.1, 1), 0.281887806787901, 1e-15);
  EXPECT_NEAR(parallel_rectangles(kUnitSquare, {1, 2, 0, 1}, 1), 0.0860504891523273, 1e-15);
  EXPECT_NEAR(perpendicular_rectangles({1, 2, 0, 1}, {1, 2, 0, 1}), 0.0329381622582032, 1e-15);
  EXPECT_NEAR(perpendicular_rectangles(kUnitSquare, {0, 1, 1, 2}), 0.0405922301015585, 1e-15);
}

TEST(Rectangles, OpposedAgainstQuadrature) {
  for (const double gap : {0.7, 1.0, 2.1, 10.0}) {
    for (const double a : {0.1, 0.6, 1.5}) {
      const double exact = parallel_by_quadrature({0, a, 0, 1}, {0, a, 0, 1}, gap);
      EXPECT_NEAR(opposed_rectangles(a, 1, gap) / exact, 1, 1e-12) << a << " x 1, gap " << gap;
    }
  }
}

TEST(Rectangles, ParallelAgainstQuadrature) {
  const Rectangle sender{-0.3, 0.4, 0, 1.1};
  for (const Rectangle receiver :
       {Rectangle{0, 1, 0, 1}, Rectangle{1, 1.5, -2, 0}, Rectangle{-2, 2, 0.5, 0.6}}) {
    const double exact = parallel_by_quadrature(sender, receiver, 1.3);
    EXPECT_NEAR(parallel_rectangles(sender, receiver, 1.3), exact, 1e-12);
    EXPECT_NEAR(area(receiver) * parallel_rectangles(receiver, sender, 1.3), area(sender) * exact, 1e-12);
  }
}

TEST(Rectangles, PerpendicularAgainstQuadrature) {
  const Rectangle sender{0.8, 1.6, 0, 1.1};
  for (const Rectangle receiver :
       {Rectangle{0, 1, 0, 1}, Rectangle{1, 1.5, -2, 0}, Rectangle{0.2, 2, 0.5, 0.6}}) {
    EXPECT_NEAR(perpendicular_rectangles(sender, receiver), perpendicular_by_quadrature(sender, receiver),
                1e-12);
  }
}

// Touching rectangles: the 4-D rule converges slowly there, sums of factors do not.
TEST(Rectangles, PerpendicularAdds) {
  const double whole = perpendicular_rectangles({0, 1, 0, 1}, {0, 1, 0, 1});
  EXPECT_NEAR(whole, adjacent_rectangles(1, 1, 1), 1e-15);
  EXPECT_NEAR(perpendicular_rectangles({0, 2, 0, 0.5}, {0, 3, 0, 0.5}), adjacent_rectangles(2, 3, 0.5),
              1e-15);
  double parts = 0;
  for (const double x : {0.0, 0.5}) {
    for (const double y : {0.0, 0.5}) {
      for (const double z : {0.0, 0.5}) {
        for (const double v : {0.0, 0.5}) {
          parts += perpendicular_rectangles({x, x + 0.5, y, y + 0.5}, {z, z + 0.5, v, v + 0.5}) / 4;
        }
      }
    }
  }
  EXPECT_NEAR(parts, whole, 1e-15);
}

// A box a x b x c seen from its floor: opposite, and two walls on each side.
TEST(Rectangles, RowsOfABoxSumToOne) {
  for (const double a : {0.01, 0.3, 1.0, 4.0}) {
    for (const double b : {0.2, 1.0, 30.0}) {
      const double row =
          opposed_rectangles(a, b, 1) + 2 * adjacent_rectangles(a, 1, b) + 2 * adjacent_rectangles(b, 1, a);
      EXPECT_NEAR(row, 1, 1e-13) << a << " x " << b;
    }
  }
}

TEST(Rectangles, Reciprocity) {
  for (const double width : {0.01, 0.5, 3.0, 100.0}) {
    EXPECT_NEAR(width * adjacent_rectangles(width, 2, 1.5), 2 * adjacent_rectangles(2, width, 1.5), 1e-14);
  }
}

TEST(Rectangles, Limits) {
  EXPECT_NEAR(adjacent_rectangles(1e-9, 1e-9, 1), 1 - std::numbers::sqrt2 / 2, 1e-9);  // infinitely long, 2-D
  EXPECT_NEAR(opposed_rectangles(1, 1, 1e-9), 1, 1e-8);                                // closed gap
  // Infinitely long opposed strips: sqrt(1 + h^2) - h, h = gap/width; the ends take gap/length or so.
  EXPECT_NEAR(opposed_rectangles(1e9, 2, 1), std::hypot(1, 0.5) - 0.5, 1e-8);
}

// Far apart the factor is area / (pi gap^2) (1 - 2 <s^2> / gap^2), s the offset of two points, its mean
// square 1/3.
TEST(Rectangles, OpposedKeepsItsDigits) {
  for (const double gap : {1e3, 1e5, 1e8}) {
    const double points = 1 / (std::numbers::pi * gap * gap);
    EXPECT_NEAR(opposed_rectangles(1, 1, gap) / points, 1 - 2 / (3 * gap * gap), 1e-11) << gap;
  }
  const double below = opposed_rectangles(3, std::nextafter(0.5, 0), 1),
               above = opposed_rectangles(3, 0.5, 1);
  EXPECT_NEAR(below / above, 1, 1e-14);
}

}  // namespace
}  // namespace fluxel::closed_forms
