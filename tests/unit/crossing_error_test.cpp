#include <gtest/gtest.h>

#include "formfactor/pair_rule.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::uniform;

/// A unit square about a centroid, and what the rules know of it.
struct Square {
  closed_forms::Polygon corners;
  FlatShape shape;

  Square(const glm::dvec3& about, const glm::dquat& turn) {
    for (const glm::dvec3& corner :
         {glm::dvec3(-0.5, -0.5, 0), {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}})
      corners.push_back(about + turn * corner);
    shape = {about, turn * glm::dvec3(0, 0, 1), 1, {1.0 / 12, glm::dvec3(0)}};
  }

  /// The face that looks towards `d` from the centroid.
  [[nodiscard]] closed_forms::Polygon facing(const glm::dvec3& d) const {
    return glm::dot(shape.normal, d) > 0 ? corners : closed_forms::Polygon(corners.rbegin(), corners.rend());
  }
};

/// How far a square reaches over the other's plane, on the side where its centroid is not [m].
double overhang(const Square& of, const Square& plane) {
  double low = 0, high = 0;
  for (const glm::dvec3& x : of.corners) {
    const double height = glm::dot(plane.shape.normal, x - plane.shape.centroid);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return std::min(-low, high);
}

const glm::dquat kLevel(1, 0, 0, 0);
/// About y, so that a level square then looks along x.
const glm::dquat kUpright = glm::angleAxis(std::numbers::pi / 2, glm::dvec3(0, 1, 0));

TEST(CrossingError, NothingWhereNeitherReachesOver) {
  std::mt19937 random(1);
  int apart = 0;
  for (int k = 0; k < 20'000; ++k) {
    const Square i(glm::dvec3(0), by_hand::random_rotation(random));
    const Square j(uniform(random, 1, 6) * test_scenes::random_direction(random),
                   by_hand::random_rotation(random));
    // A square's reach is that of a circle of half its diagonal, or less, for any turn.
    const double height = std::min(std::abs(glm::dot(i.shape.normal, j.shape.centroid)),
                                   std::abs(glm::dot(j.shape.normal, j.shape.centroid)));
    if (height < std::sqrt(0.5)) continue;
    ++apart;
    ASSERT_EQ(overhang(i, j), 0);
    ASSERT_EQ(overhang(j, i), 0);
    ASSERT_EQ(crossing_error(i.shape, j.shape), 0);
  }
  EXPECT_GT(apart, 2000);
  // Opposed and upright squares that just touch the plane.
  const Square floor(glm::dvec3(0), kLevel);
  EXPECT_EQ(crossing_error(floor.shape, Square({0, 0, 0.1}, kLevel).shape), 0);
  EXPECT_EQ(crossing_error(floor.shape, Square({3, 0, std::sqrt(0.5)}, kUpright).shape), 0);
}

TEST(CrossingError, IsTheSameEitherWay) {
  std::mt19937 random(2);
  for (int k = 0; k < 1000; ++k) {
    const Square i(glm::dvec3(0), by_hand::random_rotation(random));
    const Square j(uniform(random, 0.5, 6) * test_scenes::random_direction(random),
                   by_hand::random_rotation(random));
    const double there = crossing_error(i.shape, j.shape);
    EXPECT_NEAR(crossing_error(j.shape, i.shape), there, 1e-14 * there);
  }
}

// Squares that reach over each other's plane, 3 to 30 m apart: how far the moments rule is from the truth.
TEST(CrossingError, IsOfTheOrderOfWhatTheRuleMisses) {
  std::mt19937 random(3);
  int crossing = 0, far_off = 0;
  double missed = 0, estimated = 0;
  for (int k = 0; k < 400'000 && crossing < 4000; ++k) {
    const double distance = std::exp(uniform(random, std::log(3), std::log(30)));
    const Square i(glm::dvec3(0), by_hand::random_rotation(random));
    const Square j(distance * test_scenes::random_direction(random), by_hand::random_rotation(random));
    if (std::max(overhang(i, j), overhang(j, i)) < 0.1) continue;
    ++crossing;
    // All faces that see each other at all, whichever side the centroids are on.
    double truth = 0;
    for (const double side_i : {-1.0, 1.0})
      for (const double side_j : {-1.0, 1.0})
        truth += closed_forms::polygon_to_polygon(i.facing(side_i * i.shape.normal),
                                                  j.facing(side_j * j.shape.normal));
    const double error = std::abs(truth - pair_form_factor(PairRule::moments, i.shape, j.shape));
    const double estimate = crossing_error(i.shape, j.shape);
    ASSERT_GT(estimate, 0);
    missed += error;
    estimated += estimate;
    far_off += error > 4 * estimate + moments_error(i.shape, j.shape) ? 1 : 0;
  }
  EXPECT_EQ(crossing, 4000);
  EXPECT_GT(estimated, missed / 2);
  EXPECT_LT(estimated, 4 * missed);
  EXPECT_LT(far_off, 80);
}

// A level floor and an upright square whose middle is in the floor's plane: the rule gives 0, the truth is
// what its upper half receives.
TEST(CrossingError, AHalfRaisedWall) {
  for (const double distance : {2.0, 4.0, 8.0}) {
    const Square floor(glm::dvec3(0), kLevel), wall({distance, 0, 0}, kUpright);
    const double truth = closed_forms::polygon_to_polygon(floor.facing({0, 0, 1}), wall.facing({-1, 0, 0}));
    EXPECT_EQ(pair_form_factor(PairRule::moments, floor.shape, wall.shape) > truth / 2, false);
    const double estimate = crossing_error(floor.shape, wall.shape);
    EXPECT_GT(estimate, truth / 2);
    EXPECT_LT(estimate, 3 * truth);
  }
}

}  // namespace
}  // namespace fluxel
