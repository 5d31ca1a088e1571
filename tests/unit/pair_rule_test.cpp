#include "formfactor/pair_rule.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "core/second_moments.hpp"
#include "scene/polygon.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::uniform;

constexpr double kPi = std::numbers::pi;

Element element(const glm::vec3& centroid, const glm::vec3& normal, float area) {
  Element made;
  made.centroid = centroid;
  made.normal = normal;
  made.area = area;
  made.sides = kFront;
  return made;
}

Element random_element(std::mt19937& random, double reach) {
  return element(glm::vec3(test_scenes::uniform_point(random, -reach, reach)),
                 glm::vec3(test_scenes::random_direction(random)),
                 static_cast<float>(std::exp(uniform(random, -6, 2))));
}

TEST(PairRule, FacingSquares) {
  for (const float gap : {0.1f, 1.0f, 7.0f}) {
    const Element below = element({0, 0, 0}, {0, 0, 1}, 1), above = element({0, 0, gap}, {0, 0, -1}, 1);
    const double r2 = static_cast<double>(gap) * static_cast<double>(gap);
    EXPECT_NEAR(pair_form_factor(PairRule::point, below, above), 1 / (kPi * r2), 1e-15 / r2);
    EXPECT_NEAR(pair_form_factor(PairRule::disc, below, above), 1 / (kPi * r2 + 1), 1e-15);
  }
}

// A unit square in the floor and one in the wall along a common edge: centres 1/2 from it, both cosines
// 1/sqrt(2), r^2 = 1/2. Exact is 0.2000437760754 (C-14).
TEST(PairRule, SquaresAlongACommonEdge) {
  const Element floor = element({0.5f, 0.5f, 0}, {0, 0, 1}, 1), wall = element({0, 0.5f, 0.5f}, {1, 0, 0}, 1);
  EXPECT_NEAR(pair_form_factor(PairRule::point, floor, wall), 1 / kPi, 1e-15);
  EXPECT_NEAR(pair_form_factor(PairRule::disc, floor, wall), 0.5 / (kPi * 0.5 + 1), 1e-15);
  EXPECT_NEAR(pair_form_factor(PairRule::disc, floor, wall), 0.19449, 5e-6);
}

TEST(PairRule, TheLargerAreaBoundsBothDirections) {
  const Element small = element({0, 0, 0}, {0, 0, 1}, 0.25f), large = element({0, 0, 2}, {0, 0, -1}, 3);
  EXPECT_NEAR(pair_form_factor(PairRule::disc, small, large), 3 / (4 * kPi + 3), 1e-15);
  EXPECT_NEAR(pair_form_factor(PairRule::disc, large, small), 0.25 / (4 * kPi + 3), 1e-15);
}

TEST(PairRule, CosinesCountByMagnitude) {
  const Element floor = element({0.5f, 0.5f, 0}, {0, 0, 1}, 1), wall = element({0, 0.5f, 0.5f}, {1, 0, 0}, 1);
  const Element turned = element({0, 0.5f, 0.5f}, {-1, 0, 0}, 1);
  for (const PairRule rule : {PairRule::point, PairRule::disc})
    EXPECT_EQ(pair_form_factor(rule, floor, turned), pair_form_factor(rule, floor, wall));
}

TEST(PairRule, ExchangeIsReciprocal) {
  std::mt19937 random(1);
  for (int k = 0; k < 20'000; ++k) {
    const Element i = random_element(random, 1), j = random_element(random, 1);
    for (const PairRule rule : {PairRule::point, PairRule::disc}) {
      const double there = static_cast<double>(i.area) * pair_form_factor(rule, i, j);
      const double back = static_cast<double>(j.area) * pair_form_factor(rule, j, i);
      ASSERT_NEAR(there, back, 1e-15 * there);
    }
  }
}

TEST(PairRule, TheDiscRuleNeverExceedsOne) {
  std::mt19937 random(2);
  double largest = 0, largest_of_points = 0;
  for (int k = 0; k < 50'000; ++k) {
    const double reach = std::exp(uniform(random, -12, 0));
    const Element i = random_element(random, reach), j = random_element(random, reach);
    largest = std::max(largest, pair_form_factor(PairRule::disc, i, j));
    largest_of_points = std::max(largest_of_points, pair_form_factor(PairRule::point, i, j));
  }
  EXPECT_LE(largest, 1);
  EXPECT_GT(largest, 0.9) << "the sample has pairs that come near";
  EXPECT_GT(largest_of_points, 1e6);
}

// How far both rules are from the truth, as relative errors to the digits given.
TEST(PairRule, ErrorsOfFacingSquaresAreAsKnown) {
  struct Known {
    float gap;
    double point, point_digit, disc, disc_digit;
  };
  for (const Known& known : {Known{10, 0.00665, 5e-6, 0.0035, 5e-5}, Known{5, 0.026, 5e-4, 0.014, 7e-4},
                             Known{2, 0.16, 5e-3, 0.075, 5e-4}, Known{1, 0.59, 5e-3, 0.21, 5e-3},
                             Known{0.5f, 2, 0.5, 0.35, 5e-3}, Known{0.1f, 37, 0.6, 0.17, 5e-3}}) {
    const Element below = element({0, 0, 0}, {0, 0, 1}, 1), above = element({0, 0, known.gap}, {0, 0, -1}, 1);
    const double exact = closed_forms::opposed_rectangles(1, 1, static_cast<double>(known.gap));
    EXPECT_NEAR(pair_form_factor(PairRule::point, below, above) / exact - 1, known.point, known.point_digit);
    EXPECT_NEAR(pair_form_factor(PairRule::disc, below, above) / exact - 1, known.disc, known.disc_digit);
  }
}

/// A flat element and its corners.
struct Shape {
  Element element;
  Polygon corners;
};

Shape shape(const Polygon& polygon) {
  Outline<glm::dvec3> outline;
  std::copy(polygon.begin(), polygon.end(), outline.corner.begin());
  outline.corners = static_cast<std::uint32_t>(polygon.size());
  const SecondMoments moments = second_moments(outline);
  Shape made{element(glm::vec3(centroid(polygon)), glm::vec3(glm::normalize(area_vector(polygon))),
                     static_cast<float>(area(polygon))),
             polygon};
  made.element.minor_variance = static_cast<float>(moments.minor_variance);
  made.element.elongation = glm::vec3(moments.elongation);
  return made;
}

enum class Kind { square, rectangle, triangle };

/// Of longest edge `size` about a centroid, turned at random.
Shape random_shape(Kind kind, const glm::dvec3& middle, double size, std::mt19937& random) {
  const glm::dquat turn = by_hand::random_rotation(random);
  Polygon polygon{{0, 0, 0}, {size, 0, 0}};
  if (kind == Kind::triangle) {
    const double height = size * uniform(random, 0.2, 0.8);
    polygon.emplace_back(size * uniform(random, 0.1, 0.9), height, 0);
  } else {
    const double height = kind == Kind::square ? size : size * uniform(random, 0.2, 1);
    polygon.insert(polygon.end(), {{size, height, 0}, {0, height, 0}});
  }
  const glm::dvec3 about = centroid(polygon);
  for (glm::dvec3& corner : polygon) corner = middle + turn * (corner - about);
  return shape(polygon);
}

/// F_ij of the front and back that face each other from centroid to centroid, by the closed forms' contour
/// integral after the cut at both planes.
double exact_form_factor(const Shape& i, const Shape& j) {
  const glm::dvec3 d = centroid(j.corners) - centroid(i.corners);
  const auto facing = [](const Shape& of, const glm::dvec3& towards) {
    const bool front = glm::dot(area_vector(of.corners), towards) > 0;
    return front ? of.corners : Polygon(of.corners.rbegin(), of.corners.rend());
  };
  return closed_forms::polygon_to_polygon(facing(i, d), facing(j, -d));
}

Shape moved(Shape of, const glm::dvec3& by) {
  for (glm::dvec3& corner : of.corners) corner += by;
  return shape(of.corners);
}

TEST(MomentsRule, IsSymmetricToTheLastBits) {
  std::mt19937 random(3);
  for (int k = 0; k < 20'000; ++k) {
    const auto kind = static_cast<Kind>(k % 3), other = static_cast<Kind>(k / 3 % 3);
    const Shape i = random_shape(kind, test_scenes::uniform_point(random, -1, 1), 0.3, random);
    const Shape j = random_shape(other, test_scenes::uniform_point(random, -1, 1), 0.8, random);
    const double there =
        static_cast<double>(i.element.area) * pair_form_factor(PairRule::moments, i.element, j.element);
    const double back =
        static_cast<double>(j.element.area) * pair_form_factor(PairRule::moments, j.element, i.element);
    // Rounding in a bracket whose terms may cancel: relative to what stands before it.
    const glm::dvec3 d = glm::dvec3(j.element.centroid) - glm::dvec3(i.element.centroid);
    const double scale =
        static_cast<double>(i.element.area) * static_cast<double>(j.element.area) / glm::dot(d, d);
    ASSERT_NEAR(there, back, 4e-15 * std::max(there, scale));
    ASSERT_EQ(moments_error(i.element, j.element), moments_error(j.element, i.element));
  }
}

TEST(MomentsRule, WhichWayTheNormalsPointDoesNotMatter) {
  std::mt19937 random(4);
  for (int k = 0; k < 1000; ++k) {
    const Shape i = random_shape(Kind::rectangle, test_scenes::uniform_point(random, -1, 1), 0.3, random);
    const Shape j = random_shape(Kind::triangle, test_scenes::uniform_point(random, -1, 1), 0.3, random);
    Element turned = j.element, mirrored = i.element;
    turned.normal = -turned.normal;
    mirrored.elongation = -mirrored.elongation;
    const double F = pair_form_factor(PairRule::moments, i.element, j.element);
    ASSERT_DOUBLE_EQ(pair_form_factor(PairRule::moments, i.element, turned), F);
    ASSERT_DOUBLE_EQ(pair_form_factor(PairRule::moments, mirrored, j.element), F);
  }
}

TEST(MomentsRule, PointsInPlaceOfElementsAreThePointRule) {
  std::mt19937 random(5);
  for (int k = 0; k < 1000; ++k) {
    const Element i = random_element(random, 1), j = random_element(random, 1);  // that are points
    const double point = pair_form_factor(PairRule::point, i, j);
    ASSERT_NEAR(pair_form_factor(PairRule::moments, i, j), point, 1e-14 * point);
    ASSERT_EQ(moments_error(i, j), 0);
  }
}

// Twice as far, the relative error falls to a sixteenth; that of a rule of second order to a fourth.
TEST(MomentsRule, FallsWithTheFourthPowerOfTheDistance) {
  std::mt19937 random(6);
  for (int k = 0; k < 60; ++k) {
    const auto kind = static_cast<Kind>(k % 3), other = static_cast<Kind>(k / 3 % 3);
    const Shape i = random_shape(kind, glm::dvec3(0), 1, random);
    const Shape j = random_shape(other, glm::dvec3(0), 1, random);
    const glm::dvec3 way = test_scenes::random_direction(random);
    const auto cosine = [&way](const Shape& of) {
      return std::abs(glm::dot(glm::dvec3(of.element.normal), way));
    };
    if (cosine(i) < 0.3 || cosine(j) < 0.3) continue;
    std::array<double, 2> error{}, by_points{};
    for (std::size_t far = 0; far < 2; ++far) {
      const Shape away = moved(j, (far == 0 ? 5.0 : 10.0) * way);
      const double exact = exact_form_factor(i, away);
      error[far] = pair_form_factor(PairRule::moments, i.element, away.element) / exact - 1;
      by_points[far] = pair_form_factor(PairRule::point, i.element, away.element) / exact - 1;
    }
    EXPECT_LT(std::abs(error[0]), 0.03);
    // A term that passes through zero for this direction leaves the next one; single precision leaves 1e-6.
    EXPECT_LT(std::abs(error[1]), std::abs(error[0]) / 12 + 3e-5);
    EXPECT_LT(std::abs(error[1]), std::abs(by_points[1]) / 5 + 2e-4);
  }
}

TEST(MomentsRule, KnowsHowElementsAreElongated) {
  // 2 x 1 rectangles, across and along each other.
  for (const bool across : {false, true}) {
    for (const double gap : {6.0, 12.0}) {
      const Shape below = shape({{-1, -0.5, 0}, {1, -0.5, 0}, {1, 0.5, 0}, {-1, 0.5, 0}});
      const Shape above = across ? shape({{-0.5, -1, gap}, {-0.5, 1, gap}, {0.5, 1, gap}, {0.5, -1, gap}})
                                 : shape({{-1, -0.5, gap}, {-1, 0.5, gap}, {1, 0.5, gap}, {1, -0.5, gap}});
      const double exact = exact_form_factor(below, above);
      EXPECT_NEAR(pair_form_factor(PairRule::moments, below.element, above.element), exact,
                  8 * exact / std::pow(gap, 4));
      // Beside each other in a corner, where the long axis points along or across the way.
      const Shape wall = across ? shape({{-gap, -1, -0.5}, {-gap, 1, -0.5}, {-gap, 1, 0.5}, {-gap, -1, 0.5}})
                                : shape({{-gap, -0.5, -1}, {-gap, 0.5, -1}, {-gap, 0.5, 1}, {-gap, -0.5, 1}});
      const Shape floor = moved(below, {0, 0, -gap});
      const double in_corner = exact_form_factor(wall, floor);
      EXPECT_NEAR(pair_form_factor(PairRule::moments, wall.element, floor.element), in_corner,
                  12 * in_corner / std::pow(gap, 4));
    }
  }
}

TEST(MomentsRule, StaysBoundedWhenNear) {
  std::mt19937 random(7);
  double largest = 0;
  for (int k = 0; k < 50'000; ++k) {
    const double reach = std::exp(uniform(random, -12, 1));
    const Shape i = random_shape(static_cast<Kind>(k % 3), glm::dvec3(0), 1, random);
    const Shape j = random_shape(static_cast<Kind>(k / 3 % 3),
                                 test_scenes::uniform_point(random, -reach, reach), 1, random);
    const double F = pair_form_factor(PairRule::moments, i.element, j.element);
    ASSERT_GE(F, 0);
    ASSERT_TRUE(std::isfinite(F));
    largest =
        std::max(largest, F * static_cast<double>(i.element.area / std::max(i.element.area, j.element.area)));
  }
  EXPECT_LT(largest, 2);
}

/// The part of a height that changes sign over the other element.
bool crosses_plane(const Shape& of, const Shape& plane) {
  const glm::dvec3 normal = area_vector(plane.corners);
  const auto side = [&](const glm::dvec3& x) { return glm::dot(normal, x - plane.corners[0]) > 0; };
  return std::ranges::any_of(of.corners, side) && !std::ranges::all_of(of.corners, side);
}

/// The largest error in units of the estimate plus `third_order` times (size / r)^3, of 4000 pairs of the
/// kinds below `kinds` for which the estimate is below a tenth of F.
double worst_ratio(int kinds, double largest_size, double third_order, std::mt19937& random) {
  double worst = 0;
  int counted = 0;
  for (int k = 0; counted < 4000 && k < 200'000; ++k) {
    const Shape i = random_shape(static_cast<Kind>(k % kinds), glm::dvec3(0), 1, random);
    const double distance = std::exp(uniform(random, 0, 3));
    const Shape j =
        random_shape(static_cast<Kind>(k / kinds % kinds), distance * test_scenes::random_direction(random),
                     std::exp(uniform(random, -std::log(largest_size), std::log(largest_size))), random);
    const double estimate = moments_error(i.element, j.element);
    const double F_ij = pair_form_factor(PairRule::moments, i.element, j.element);
    const double F_ji = pair_form_factor(PairRule::moments, j.element, i.element);
    if (estimate > 0.1 * std::max(F_ij, F_ji)) continue;
    if (crosses_plane(i, j) || crosses_plane(j, i)) continue;
    ++counted;
    const double there = exact_form_factor(i, j);
    const double back = there * area(i.corners) / area(j.corners);
    const double error = std::max(std::abs(there - F_ij), std::abs(back - F_ji));
    // An element's centroid and normal are single precision, and cosines lose by that what they are.
    const double largest_area = std::max(area(i.corners), area(j.corners));
    const double point = largest_area / (kPi * distance * distance);
    const double size = std::sqrt(largest_area) / distance;
    worst = std::max(worst, (error - 3e-7 * point) / (estimate + third_order * std::pow(size, 3) * point));
  }
  EXPECT_EQ(counted, 4000);
  return worst;
}

TEST(MomentsRule, TheErrorEstimateTellsTheSizeOfTheError) {
  std::mt19937 random(8);
  constexpr int kParallelograms = 2, kAll = 3;
  const double alike = worst_ratio(kParallelograms, 1.5, 0, random);
  EXPECT_LT(alike, 8);
  EXPECT_GT(alike, 0.05) << "nor is it useless";
  EXPECT_LT(worst_ratio(kParallelograms, 10, 0, random), 8);
  // Triangles have third moments, which neither rule nor estimate knows.
  EXPECT_LT(worst_ratio(kAll, 1.5, 0.1, random), 4);
  EXPECT_LT(worst_ratio(kAll, 10, 0.1, random), 4);
}

}  // namespace
}  // namespace fluxel
