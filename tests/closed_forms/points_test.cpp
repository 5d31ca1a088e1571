#include "tests/closed_forms/points.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/closed_forms/polygons.hpp"
#include "tests/closed_forms/quadrature.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::closed_forms {
namespace {

TEST(Points, CheckValues) {
  EXPECT_NEAR(point_to_parallel_rectangle(kUnitSquare, 1), 0.138531605994893, 1e-15);
  EXPECT_NEAR(point_to_parallel_rectangle({-0.5, 0.5, -0.5, 0.5}, 0.5), 0.554126423979572, 1e-15);
  EXPECT_NEAR(point_to_perpendicular_rectangle(1, kUnitSquare), 0.0557341970025535, 1e-16);
  EXPECT_NEAR(point_to_polygon(kOrigin, kZ, {{1, 0, 1}, {0, 1, 1}, {-1, -1, 1}}), 0.300349190096869, 1e-15);
  EXPECT_DOUBLE_EQ(point_to_coaxial_disc(3, 3), 0.5);
}

TEST(Points, AgainstQuadrature) {
  for (const Rectangle receiver : {kUnitSquare, Rectangle{-0.2, 1, 0.5, 2}, Rectangle{0.1, 0.4, -3, -2}}) {
    const double parallel = integrate<30>(receiver, [](double x, double y) {
      return kernel(kOrigin, kZ, {x, y, 1.2}, -kZ);
    });
    EXPECT_NEAR(point_to_parallel_rectangle(receiver, 1.2), parallel, 1e-13);
  }
  for (const Rectangle receiver : {kUnitSquare, Rectangle{0.2, 1, -0.5, 1}, Rectangle{1, 4, -3, -2}}) {
    const double perpendicular = integrate<30>(receiver, [](double z, double y) {
      return kernel(1.2 * kX, kZ, {0, y, z}, kX);
    });
    EXPECT_NEAR(point_to_perpendicular_rectangle(1.2, receiver), perpendicular, 1e-12);
  }
  // The disc in polar coordinates.
  const auto ring = [](double r) { return 2 * std::numbers::pi * r * kernel(kOrigin, kZ, {r, 0, 0.8}, -kZ); };
  EXPECT_NEAR(point_to_coaxial_disc(1.1, 0.8), integrate<30>(0, 1.1, ring), 1e-14);
}

TEST(Points, LambertIsTheSame) {
  const Rectangle receiver{0.3, 1.7, -0.4, 2};
  EXPECT_NEAR(point_to_polygon(kOrigin, kZ, horizontal(receiver, 0.6)),
              point_to_parallel_rectangle(receiver, 0.6), 1e-15);
  EXPECT_NEAR(point_to_polygon(0.6 * kX, kZ, facing_x(receiver, 0)),
              point_to_perpendicular_rectangle(0.6, receiver), 1e-15);
}

// A wall that reaches below the horizon counts only above it.
TEST(Points, LambertIsCutAtTheHorizon) {
  EXPECT_NEAR(point_to_polygon(kX, kZ, facing_x({-5, 1, 0, 1}, 0)), 0.0557341970025535, 1e-15);
  EXPECT_EQ(point_to_polygon(kX, kZ, facing_x({-5, 0, 0, 1}, 0)), 0);
}

TEST(Points, LambertClosesAroundAPoint) {
  double sum = 0;
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1, -2, 0.3));
  for (const Polygon& face : cube(kOrigin, 1)) sum += point_to_polygon({0.1, 0.2, -0.4}, normal, face);
  EXPECT_NEAR(sum, 1, 1e-15);
}

// A square lamp of 1 m at 3 m, the floor point beside its centre: configuration factors as of CIE
// 171:2006, 5.3.
TEST(Points, FloorBelowALamp) {
  const std::array expected{0.0341067948997, 0.0324080784207, 0.0279891563026, 0.0223622043846,
                            0.0169106400921};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double offset = 0.5 * double(i);
    EXPECT_NEAR(point_to_parallel_rectangle({offset - 0.5, offset + 0.5, -0.5, 0.5}, 3), expected[i], 6e-14);
  }
}

// The Cornell box's lamp, of exitance 1, at points that see all of it; coordinates as published, in
// millimetres.
TEST(Points, CornellBoxLamp) {
  const Polygon lamp{{343, 548.8, 227}, {343, 548.8, 332}, {213, 548.8, 332}, {213, 548.8, 227}};
  EXPECT_NEAR(point_to_polygon({40, 0, 300}, kY, lamp), 0.0101398888, 1e-10);
  EXPECT_NEAR(point_to_polygon({60, 0, 500}, kY, lamp), 0.0082621830, 1e-10);
  EXPECT_NEAR(point_to_polygon({278, 450, 559.2}, -kZ, lamp), 0.0157463761, 1e-10);
  EXPECT_NEAR(point_to_polygon({0, 274.4, 279.6}, kX, lamp), 0.0140631657, 1e-10);
  EXPECT_NEAR(point_to_polygon({186, 165, 170}, kY, lamp), 0.0223379422, 1e-10);
  EXPECT_NEAR(point_to_polygon({368, 330, 351}, kY, lamp), 0.0542981805, 1e-10);
  EXPECT_NEAR(point_to_polygon({278, 0, 30}, kY, lamp), 0.0098323990, 1e-10);
}

}  // namespace
}  // namespace fluxel::closed_forms
