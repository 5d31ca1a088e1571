#include "formfactor/pair_rule.hpp"

#include <gtest/gtest.h>

#include <numbers>

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

/// Two unit squares face each other across a gap: Howell's catalogue, C-11.
double exact_opposed_squares(double gap) {
  const double x = 1 / gap, s = std::sqrt(1 + x * x);
  const double terms = std::log(std::sqrt((1 + x * x) * (1 + x * x) / (1 + 2 * x * x))) +
                       2 * x * s * std::atan(x / s) - 2 * x * std::atan(x);
  return 2 / (kPi * x * x) * terms;
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
  EXPECT_NEAR(exact_opposed_squares(1), 0.199824895698387, 1e-14);
  struct Known {
    float gap;
    double point, point_digit, disc, disc_digit;
  };
  for (const Known& known : {Known{10, 0.00665, 5e-6, 0.0035, 5e-5}, Known{5, 0.026, 5e-4, 0.014, 7e-4},
                             Known{2, 0.16, 5e-3, 0.075, 5e-4}, Known{1, 0.59, 5e-3, 0.21, 5e-3},
                             Known{0.5f, 2, 0.5, 0.35, 5e-3}, Known{0.1f, 37, 0.6, 0.17, 5e-3}}) {
    const Element below = element({0, 0, 0}, {0, 0, 1}, 1), above = element({0, 0, known.gap}, {0, 0, -1}, 1);
    const double exact = exact_opposed_squares(static_cast<double>(known.gap));
    EXPECT_NEAR(pair_form_factor(PairRule::point, below, above) / exact - 1, known.point, known.point_digit);
    EXPECT_NEAR(pair_form_factor(PairRule::disc, below, above) / exact - 1, known.disc, known.disc_digit);
  }
}

}  // namespace
}  // namespace fluxel
