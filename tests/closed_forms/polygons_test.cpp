#include "tests/closed_forms/polygons.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "tests/closed_forms/quadrature.hpp"
#include "tests/closed_forms/rectangles.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::closed_forms {
namespace {

Polygon moved(Polygon polygon) {
  const glm::dquat turn = glm::angleAxis(1.1, glm::normalize(glm::dvec3(1, 2, -0.4)));
  for (glm::dvec3& corner : polygon) corner = turn * corner + glm::dvec3(0.3, -0.7, 0.2);
  return polygon;
}

TEST(Polygons, PrintedValues) {
  const double radian = std::numbers::pi / 180;
  const auto hinged = [&](double degrees) {
    const auto [lying, raised] = hinged_squares(degrees * radian);
    return polygon_to_polygon(lying, raised);
  };
  EXPECT_NEAR(hinged(30), 0.6190283230908, 1e-13);
  EXPECT_NEAR(hinged(60), 0.37090532115005, 1e-14);
  EXPECT_NEAR(hinged(90), 0.2000437760754, 1e-13);
  EXPECT_NEAR(polygon_to_polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 1}, {1, 0, 1}, {0, 0, 1}}),
              0.11504922814961, 1e-14);
  EXPECT_NEAR(polygon_to_polygon(regular_polygon(6, 1, 0), reversed(regular_polygon(6, 1, 1))),
              0.34857587661010, 1e-14);
}

TEST(Polygons, RectanglesInAnyPlace) {
  const auto expect = [](double exact, const Polygon& sender, const Polygon& receiver) {
    EXPECT_NEAR(polygon_to_polygon(sender, receiver), exact, 1e-13);
    EXPECT_NEAR(polygon_to_polygon(moved(sender), moved(receiver)), exact, 1e-13);
    EXPECT_NEAR(exchange_area(moved(receiver), moved(sender)), exact * area(sender), 1e-13);
  };
  const Polygon square = horizontal(kUnitSquare, 0);
  for (const double gap : {0.01, 0.3, 1.0, 7.0}) {
    expect(opposed_rectangles(1, 1, gap), square, reversed(horizontal(kUnitSquare, gap)));
  }
  expect(parallel_rectangles(kUnitSquare, {1, 2, 0, 1}, 1), square, reversed(horizontal({1, 2, 0, 1}, 1)));
  expect(adjacent_rectangles(1, 2, 1), square, facing_x({0, 2, 0, 1}, 0));
  expect(perpendicular_rectangles(kUnitSquare, {0, 1, 1, 2}), square, facing_x({0, 1, 1, 2}, 0));
}

// Squares at an angle, by Lambert's point factor integrated over the first; smooth but at the common edge.
TEST(Polygons, HingedSquaresAgainstPoints) {
  for (const double angle : {0.4, 1.0, 2.5}) {
    const auto [lying, raised] = hinged_squares(angle);
    const auto strip = [&, &receiver = raised](double root) {
      const double x = root * root * root;  // gathers points at the edge
      return 3 * root * root * integrate<30>(0, 1, [&](double y) {
               return point_to_polygon({x, y, 0}, kZ, receiver);
             });
    };
    double by_points = 0;
    for (int i = 0; i < 8; ++i) by_points += integrate<30>(i / 8.0, (i + 1) / 8.0, strip);
    EXPECT_NEAR(polygon_to_polygon(lying, raised), by_points, 1e-6) << angle;
  }
}

// A wedge of infinitely long faces has 1 - sin(angle/2); unit squares exchange less, a nearly closed pair
// all.
TEST(Polygons, HingedSquaresOverAllAngles) {
  double last = 1;
  for (int degrees = 1; degrees < 180; ++degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const auto [lying, raised] = hinged_squares(angle);
    const double found = polygon_to_polygon(lying, raised);
    EXPECT_LT(found, last);
    EXPECT_LT(found, 1 - std::sin(angle / 2));
    EXPECT_GT(found, 0);
    last = found;
  }
}

TEST(Polygons, TetrahedraClose) {
  const std::vector<Polygon> faces{{{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0}},
                                   {{0, 0, 0}, {0.3, 0.4, 0.8}, {1, 0, 0}},
                                   {{1, 0, 0}, {0.3, 0.4, 0.8}, {0.2, 0.9, 0}},
                                   {{0.2, 0.9, 0}, {0.3, 0.4, 0.8}, {0, 0, 0}}};
  for (const Polygon& sender : faces) {
    double row = 0;
    for (const Polygon& receiver : faces) {
      if (&receiver != &sender) row += polygon_to_polygon(sender, receiver);
    }
    EXPECT_NEAR(row, 1, 1e-13);
  }
}

// A wall that crosses the floor's plane, and a floor that crosses the wall's.
TEST(Polygons, WhatLiesBehindIsCutOff) {
  EXPECT_NEAR(exchange_area(horizontal({-2, 1, 0, 1}, 0), facing_x({-3, 1, 0, 1}, 0)),
              adjacent_rectangles(1, 1, 1), 1e-13);
  EXPECT_EQ(exchange_area(horizontal(kUnitSquare, 0), horizontal(kUnitSquare, 1)), 0);   // face to back
  EXPECT_EQ(exchange_area(horizontal(kUnitSquare, 0), horizontal({1, 2, 0, 1}, 0)), 0);  // one plane
  EXPECT_EQ(exchange_area(reversed(horizontal(kUnitSquare, 0)), facing_x({0, 1, 0, 1}, 0)), 0);  // behind
}

TEST(Shapes, ClosedAndOutwards) {
  const glm::dvec3 centre(0.3, -1, 2);
  for (const auto& body : {cube(centre, 1.5), geodesic_sphere(4, centre, 1.5)}) {
    glm::dvec3 sum(0);
    for (const Polygon& face : body) {
      sum += vector_area(face);
      EXPECT_GT(glm::dot(vector_area(face), face[0] - centre), 0);
      for (const Polygon& other : body) {  // convex: no corner lies before a face
        for (const glm::dvec3& corner : other) {
          EXPECT_LT(glm::dot(vector_area(face), corner - face[0]), 1e-14);
        }
      }
    }
    EXPECT_NEAR(glm::length(sum), 0, 1e-13);
  }
  EXPECT_EQ(geodesic_sphere(4, centre, 1.5).size(), 320U);
  EXPECT_NEAR(area(geodesic_sphere(4, centre, 1.5)), 4 * std::numbers::pi * 2.25, 1e-12);
  EXPECT_NEAR(area(cube(centre, 1.5)), 6 * 2.25, 1e-13);
  EXPECT_NEAR(area(disc(64, 2, 0)), 4 * std::numbers::pi, 1e-13);
  EXPECT_GT(vector_area(disc(64, 2, 0)).z, 0);
}

}  // namespace
}  // namespace fluxel::closed_forms
