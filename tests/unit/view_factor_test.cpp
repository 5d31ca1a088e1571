#include "formfactor/view_factor.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/closed_forms/cases.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using closed_forms::Rectangle;
using test_scenes::uniform;

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kUp(0, 0, 1);
const Polygon kUnitSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

double clipped_area(const Polygon& polygon, const Plane& plane) {
  return area(corners(clip_to_front(polygon, plane)));
}

TEST(ClipToFront, KeepsOrDropsTheWhole) {
  const SmallPolygon all = clip_to_front(kUnitSquare, {{0, 0, -1}, kUp});
  EXPECT_EQ(Polygon(all.begin(), all.end()), kUnitSquare);
  EXPECT_TRUE(clip_to_front(kUnitSquare, {{0, 0, 1}, kUp}).empty());
  EXPECT_TRUE(clip_to_front(kUnitSquare, {{0, 0, 0}, kUp}).empty())
      << "in the plane nothing is in front of it";
}

TEST(ClipToFront, CornersInThePlaneBelongToIt) {
  EXPECT_TRUE(clip_to_front(kUnitSquare, {{0, 0, 0}, {-1, 0, 0}}).empty())
      << "an edge in the plane has no area";
  EXPECT_EQ(clip_to_front(kUnitSquare, {{0, 0, 0}, {1, 0, 0}}).size(), 4u);
  const glm::dvec3 diagonal = glm::normalize(glm::dvec3(1, 1, 0));
  EXPECT_TRUE(clip_to_front(kUnitSquare, {{0, 0, 0}, -diagonal}).empty()) << "nor has a corner";
  EXPECT_EQ(clip_to_front(kUnitSquare, {{1, 0, 0}, diagonal}).size(), 3u) << "through two corners";
}

TEST(ClipToFront, TheToleranceLeavesNoSlivers) {
  const Plane aside{{1e-9, 0, 0}, {1, 0, 0}};
  const SmallPolygon whole = clip_to_front(kUnitSquare, aside, 1e-8);
  EXPECT_EQ(Polygon(whole.begin(), whole.end()), kUnitSquare);
  EXPECT_TRUE(clip_to_front(kUnitSquare, {{1e-9, 0, 0}, {-1, 0, 0}}, 1e-8).empty());
  EXPECT_FALSE(clip_to_front(kUnitSquare, {{1e-9, 0, 0}, {-1, 0, 0}}).empty());
}

TEST(ClipToFront, BothSidesAddUpToThePolygon) {
  std::mt19937 random(1);
  const Polygon hexagon = closed_forms::regular_polygon(6, 1, 0);
  int cut = 0;
  for (int k = 0; k < 2000; ++k) {
    const glm::dvec3 normal = test_scenes::random_direction(random);
    const glm::dvec3 point = test_scenes::uniform_point(random, -1, 1);
    const double front = clipped_area(hexagon, {point, normal});
    const double back = clipped_area(hexagon, {point, -normal});
    ASSERT_NEAR(front + back, area(hexagon), 1e-14);
    for (const glm::dvec3& corner : clip_to_front(hexagon, {point, normal}))
      ASSERT_GE(glm::dot(corner - point, normal), -1e-15);
    cut += front > 0 && back > 0 ? 1 : 0;
  }
  EXPECT_GT(cut, 200);
}

TEST(PointToPolygon, ClosedForms) {
  for (const closed_forms::PointCase& view : closed_forms::point_cases())
    EXPECT_NEAR(point_to_polygon(view.point, view.normal, view.receiver),
                view.exact * (1 + view.geometry_error), 1e-15)
        << view.id << ' ' << view.what;
}

/// The kernel over small pieces of a triangle; the horizon cuts pieces, hence the loose bound.
double by_pieces(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& triangle, int pieces) {
  const glm::dvec3 u = (triangle[1] - triangle[0]) / static_cast<double>(pieces);
  const glm::dvec3 v = (triangle[2] - triangle[0]) / static_cast<double>(pieces);
  const glm::dvec3 across = glm::cross(u, v);
  const double piece = glm::length(across) / 2;
  double sum = 0;
  const auto add = [&](double s, double t) {
    const glm::dvec3 d = triangle[0] + s * u + t * v - point;
    const double r2 = glm::dot(d, d);
    sum += piece * std::max(0.0, glm::dot(normal, d)) * std::abs(glm::dot(across, d)) / (2 * piece) /
           (kPi * r2 * r2);
  };
  for (int a = 0; a < pieces; ++a) {
    for (int b = 0; a + b < pieces; ++b) {
      add(a + 1.0 / 3, b + 1.0 / 3);
      if (a + b < pieces - 1) add(a + 2.0 / 3, b + 2.0 / 3);
    }
  }
  return sum;
}

TEST(PointToPolygon, AgreesWithPiecesAcrossTheHorizon) {
  std::mt19937 random(2);
  int crossing = 0;
  for (int k = 0; k < 200; ++k) {
    const Polygon triangle{test_scenes::uniform_point(random, -1, 1),
                           test_scenes::uniform_point(random, -1, 1),
                           test_scenes::uniform_point(random, -1, 1)};
    const glm::dvec3 normal = test_scenes::random_direction(random);
    const glm::dvec3 point = centroid(triangle) + 2.0 * test_scenes::random_direction(random);
    const double F = point_to_polygon(point, normal, triangle);
    EXPECT_NEAR(F, by_pieces(point, normal, triangle, 60), 1e-3 * F + 1e-5);
    const double front = clipped_area(triangle, {point, normal});
    crossing += front > 0 && front < 0.999 * area(triangle) ? 1 : 0;
  }
  EXPECT_GT(crossing, 20);
}

TEST(PointToPolygon, LiesBetweenNothingAndAll) {
  const Polygon wide{{-1e6, -1e6, 0}, {1e6, -1e6, 0}, {1e6, 1e6, 0}, {-1e6, 1e6, 0}};
  EXPECT_NEAR(point_to_polygon({0, 0, -1e-6}, kUp, wide), 1, 1e-15);
  EXPECT_LE(point_to_polygon({0, 0, -1e-6}, kUp, wide), 1);
  EXPECT_EQ(point_to_polygon({0, 0, 1e-6}, kUp, wide), 0) << "behind";
  EXPECT_EQ(point_to_polygon({0, 0, 0}, kUp, wide), 0) << "on it";
  EXPECT_EQ(point_to_polygon({0, 0, 0}, {1, 0, 0}, wide), 0) << "on it, upright: only an edge is in view";
  EXPECT_EQ(point_to_polygon({5, 0, 0}, kUp, kUnitSquare), 0) << "in its plane";
  EXPECT_EQ(point_to_polygon({0, 0, 0}, kUp, kUnitSquare), 0) << "at a corner";
  EXPECT_NEAR(point_to_polygon({0.5, 0.5, 0}, {1, 0, 0}, kUnitSquare), 0, 1e-15);
}

TEST(PointToPolygon, BothFacesAndAnyOrderOfCorners) {
  const glm::dvec3 point(0.2, 0.3, -0.7), normal = glm::normalize(glm::dvec3(1, 0.2, 0.4));
  const Polygon reversed(kUnitSquare.rbegin(), kUnitSquare.rend());
  const double F = point_to_polygon(point, normal, kUnitSquare);
  EXPECT_GT(F, 0.01);
  EXPECT_NEAR(point_to_polygon(point, normal, reversed), F, 1e-16);
}

TEST(PointToPolygon, PartsAddUpAndScaleDoesNotMatter) {
  std::mt19937 random(3);
  for (int k = 0; k < 500; ++k) {
    const glm::dvec3 point = test_scenes::uniform_point(random, -1, 1);
    const glm::dvec3 normal = test_scenes::random_direction(random);
    const Halves halves =
        split(kUnitSquare,
              {test_scenes::uniform_point(random, 0.2, 0.8), test_scenes::random_direction(random)}, 0);
    if (halves.front.empty() || halves.back.empty()) continue;
    const double whole = point_to_polygon(point, normal, kUnitSquare);
    ASSERT_NEAR(point_to_polygon(point, normal, halves.front) + point_to_polygon(point, normal, halves.back),
                whole, 2e-15);
    for (const double scale : {0x1p-10, 0x1p10}) {
      Polygon scaled = kUnitSquare;
      for (glm::dvec3& corner : scaled) corner *= scale;
      ASSERT_EQ(point_to_polygon(scale * point, normal, scaled), whole);
    }
  }
}

/// Errors of both rules and both orders against a value [m2].
void expect_exchange(const Polygon& P, const Polygon& Q, double exact, double coarse, double fine,
                     const std::string& what) {
  EXPECT_NEAR(exchange_area_by_contour(P, Q, ContourPoints::coarse), exact, coarse) << what;
  EXPECT_NEAR(exchange_area_by_contour(P, Q, ContourPoints::fine), exact, fine) << what;
  EXPECT_NEAR(exchange_area_by_contour(Q, P, ContourPoints::coarse), exact, coarse) << what;
  EXPECT_NEAR(exchange_area_by_contour(Q, P, ContourPoints::fine), exact, fine) << what;
}

TEST(ExchangeArea, ClosedForms) {
  for (const closed_forms::Case& view : closed_forms::flat_cases()) {
    ASSERT_EQ(view.sender.size(), 1u);
    ASSERT_EQ(view.receiver.size(), 1u);
    const double G = view.exact * closed_forms::area(view.sender[0]);
    expect_exchange(view.sender[0], view.receiver[0], G, 1e-4 * G, 3e-9 * G, view.id);
  }
}

TEST(ExchangeArea, EveryDihedralAngle) {
  for (int degrees = 1; degrees < 180; ++degrees) {
    const auto [lying, raised] = closed_forms::hinged_squares(degrees * kPi / 180);
    // Absolute: towards 180 degrees the squares see ever less of each other, and the contour's terms cancel.
    expect_exchange(lying, raised, closed_forms::exchange_area(lying, raised), 2e-5, 5e-10,
                    std::to_string(degrees) + " degrees");
  }
}

TEST(ExchangeArea, EveryGap) {
  for (double gap = 1e-3; gap < 101; gap *= std::pow(10.0, 0.25)) {
    const Polygon above = closed_forms::reversed(closed_forms::horizontal({0, 1, 0, 1}, gap));
    const double exact = closed_forms::opposed_rectangles(1, 1, gap);
    expect_exchange(kUnitSquare, above, exact, 1e-4 * exact, 1e-8 * exact, "gap " + std::to_string(gap));
  }
}

TEST(ExchangeArea, ScaleAndShiftDoNotMatter) {
  const Polygon floor = closed_forms::horizontal({0, 1, 0, 1}, 0);
  const Polygon wall = closed_forms::facing_x({0, 1, 0.25, 1.5}, 0);
  const double exact = closed_forms::perpendicular_rectangles({0, 1, 0, 1}, {0, 1, 0.25, 1.5});
  for (const double scale : {1e-3, 1e-2, 1.0, 10.0, 1e3}) {
    for (const double shift : {0.0, 1e3}) {
      Polygon P = floor, Q = wall;
      for (Polygon* polygon : {&P, &Q})
        for (glm::dvec3& corner : *polygon) corner = scale * corner + shift * glm::dvec3(1, -0.7, 0.3);
      // Coordinates are rounded to 1e-13 of the shift, which the view factor shows relative to the size.
      const double rounding = 1e-12 * shift / scale;
      const double G = exact * scale * scale;
      expect_exchange(P, Q, G, (1e-4 + rounding) * G, (1e-8 + rounding) * G,
                      "scale " + std::to_string(scale) + " shift " + std::to_string(shift));
    }
  }
}

// A sliver's long edges nearly cancel: what matters is the error relative to its area. Against a square that
// it touches with a long edge, as triangles of every shape and as a strip.
TEST(ExchangeArea, SliversAlongACommonEdge) {
  for (const double width : {1e-1, 1e-2, 1e-4, 1e-6}) {
    const std::string what = "width " + std::to_string(width);
    const double exact = closed_forms::adjacent_rectangles(1, width, 1);  // from the square, of area 1
    expect_exchange(kUnitSquare, closed_forms::facing_x({0, width, 0, 1}, 0), exact, 5e-4 * width,
                    2e-6 * width, what);
    // In the limit every point of the sliver sees half of its surroundings filled.
    const double half = width / 4, off = width * std::sqrt(width);
    for (const double apex : {0.0, 0.5, 1.0})
      expect_exchange(kUnitSquare, {{0, 0, 0}, {0, 1, 0}, {0, apex, width}}, half, 5e-4 * width + off,
                      2e-6 * width + off, what);
  }
}

// The other long edge is nearer to the square's far edge than that is long, or not: both must be integrated
// by the same rule.
TEST(ExchangeArea, OpposedSlivers) {
  for (const double width : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    for (const double gap : {0.1, 0.3, 1.0, 3.0}) {
      const Rectangle strip{0, width, 0, 1};
      const double G = width * closed_forms::opposed_rectangles(width, 1, gap);
      expect_exchange(closed_forms::horizontal(strip, 0),
                      closed_forms::reversed(closed_forms::horizontal(strip, gap)), G, 1e-3 * G,
                      1e-7 * G + 1e-17, "width " + std::to_string(width) + " gap " + std::to_string(gap));
    }
  }
}

TEST(ExchangeArea, PartsAddUp) {
  std::mt19937 random(4);
  for (int k = 0; k < 300; ++k) {
    const double angle = uniform(random, 0.2, 2.8);
    const auto [lying, raised] = closed_forms::hinged_squares(angle);
    const Plane cut{glm::dvec3(0.5, 0.5, 0) + 0.4 * test_scenes::uniform_point(random, -1, 1),
                    test_scenes::random_direction(random)};
    const Halves halves = split(lying, cut, 1e-6);
    if (halves.front.empty() || halves.back.empty()) continue;
    for (const auto& [points, bound] :
         {std::pair{ContourPoints::coarse, 3e-4}, std::pair{ContourPoints::fine, 1e-8}}) {
      const double whole = exchange_area_by_contour(lying, raised, points);
      const double parts = exchange_area_by_contour(halves.front, raised, points) +
                           exchange_area_by_contour(halves.back, raised, points);
      EXPECT_NEAR(parts, whole, bound * whole) << "angle " << angle;
    }
  }
}

/// A random triangle or parallelogram before the plane z = 0, facing it, or nothing.
Polygon random_polygon(std::mt19937& random, double height) {
  const glm::dvec3 a = test_scenes::uniform_point(random, -1, 1) + glm::dvec3(0, 0, height);
  const glm::dvec3 u = test_scenes::random_direction(random), v = test_scenes::random_direction(random);
  Polygon polygon{a, a + u, a + v};
  if (uniform(random, 0, 1) < 0.5) polygon.insert(polygon.begin() + 2, a + u + v);
  if (area_vector(polygon).z > 0) std::ranges::reverse(polygon);
  return polygon;
}

/// (longest edge or diagonal)^2 over the area.
double slenderness(PolygonView polygon) {
  double longest = 0;
  for (const glm::dvec3& a : polygon)
    for (const glm::dvec3& b : polygon) longest = std::max(longest, glm::dot(a - b, a - b));
  return longest / area(polygon);
}

TEST(ExchangeArea, RandomPolygonsAgainstTheGradedRule) {
  std::mt19937 random(5);
  double coarse = 0, coarse_sliver = 0, fine = 0;  // largest errors over the smaller area
  for (int k = 0; k < 3000; ++k) {
    const Polygon Q = random_polygon(random, uniform(random, 0, 3));
    const SmallPolygon above = clip_to_front(Q, {{0, 0, 0}, kUp});
    const glm::dvec3 normal = glm::normalize(area_vector(Q));
    const SmallPolygon below = clip_to_front(kUnitSquare, {Q[0], normal});
    if (above.empty() || below.empty()) continue;
    const double least = std::min(area(corners(above)), area(corners(below)));
    const double slender = std::max(slenderness(corners(above)), slenderness(corners(below)));
    if (least < 1e-6 || slender > 256) continue;
    const double exact =
        closed_forms::exchange_area({below.begin(), below.end()}, {above.begin(), above.end()});
    const auto error = [&](ContourPoints points) {
      return std::abs(exchange_area_by_contour(corners(below), corners(above), points) - exact) / least;
    };
    double& worst_coarse = slender > 8 ? coarse_sliver : coarse;
    worst_coarse = std::max(worst_coarse, error(ContourPoints::coarse));
    fine = std::max(fine, error(ContourPoints::fine));
  }
  EXPECT_LT(coarse, 9e-5);
  EXPECT_LT(coarse_sliver, 1e-3);
  EXPECT_LT(fine, 2e-7);
  RecordProperty("worst_coarse", std::to_string(coarse));
  RecordProperty("worst_coarse_of_slivers", std::to_string(coarse_sliver));
}

// Where edges pass each other closely between their ends, the integrand bends although no corner is near.
TEST(ExchangeArea, EdgesThatPassEachOther) {
  for (const double gap : {0.01, 0.03, 0.1, 0.3}) {
    for (const int corners_above : {3, 4, 5}) {
      Polygon above = closed_forms::reversed(closed_forms::regular_polygon(corners_above, 0.6, gap));
      for (glm::dvec3& corner : above) corner += glm::dvec3(0.47, 0.52, 0);
      expect_exchange(kUnitSquare, above, closed_forms::exchange_area(kUnitSquare, above), 2e-5, 3e-9,
                      std::to_string(corners_above) + " corners, gap " + std::to_string(gap));
    }
  }
}

TEST(ExchangeArea, NothingOfNothing) {
  const Polygon line{{0, 0, 1}, {1, 0, 1}, {1, 0, 1}, {0, 0, 1}}, point{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  for (const ContourPoints points : {ContourPoints::coarse, ContourPoints::fine}) {
    EXPECT_NEAR(exchange_area_by_contour(kUnitSquare, line, points), 0, 1e-15);
    EXPECT_EQ(exchange_area_by_contour(kUnitSquare, point, points), 0);
    EXPECT_EQ(exchange_area_by_contour(kUnitSquare, {}, points), 0);
  }
}

}  // namespace
}  // namespace fluxel
