#include "formfactor/shadowed_exchange.hpp"

#include <gtest/gtest.h>

#include "scene/occluding_patches.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using closed_forms::Rectangle;

constexpr Rectangle kUnit{0, 1, 0, 1};
constexpr double kLift = 1e-6;

SampledPolygon sampled(const closed_forms::Polygon& polygon) {
  return {{polygon.begin(), polygon.end()}, glm::normalize(closed_forms::vector_area(polygon))};
}

std::optional<ShadowedArea> past(const SampledPolygon& P, const SampledPolygon& Q,
                                 const std::vector<closed_forms::Polygon>& occluders, double tolerance) {
  const std::vector<PolygonView> views(occluders.begin(), occluders.end());
  return shadowed_exchange(P, Q, views, kLift, tolerance);
}

/// Opposed unit squares 1 m apart and plates at a height between them.
std::optional<ShadowedArea> opposed(const std::vector<Rectangle>& plates, double height, double tolerance) {
  std::vector<closed_forms::Polygon> polygons;
  for (const Rectangle& plate : plates) polygons.push_back(closed_forms::horizontal(plate, height));
  return past(sampled(closed_forms::horizontal(kUnit, 0)),
              sampled(closed_forms::reversed(closed_forms::horizontal(kUnit, 1))), polygons, tolerance);
}

TEST(ShadowedExchange, PlatesHalfWay) {
  const std::vector<std::vector<Rectangle>> cases{
      {{0, 0.5, 0, 1}}, {{0, 0.5, 0, 0.5}}, {{0, 0.25, 0, 1}, {0.5, 0.75, 0, 1}}, {{0.25, 0.75, 0.25, 0.75}}};
  for (const std::vector<Rectangle>& plates : cases) {
    const double exact = closed_forms::opposed_squares_past(plates);
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
      const std::optional<ShadowedArea> found = opposed(plates, 0.5, tolerance);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->G, exact, found->error + 2 * kLift) << tolerance;
      EXPECT_LE(found->error, tolerance);
    }
  }
}

// Seen from near the plate its shadow is large; both ways of looking must agree.
TEST(ShadowedExchange, WhicheverPolygonThePlateIsNear) {
  const Rectangle plate{0.2, 0.5, 0.3, 0.9};
  const std::optional<ShadowedArea> low = opposed({plate}, 0.1, 1e-5), high = opposed({plate}, 0.9, 1e-5);
  ASSERT_TRUE(low && high);
  EXPECT_NEAR(low->G, high->G, low->error + high->error + 2 * kLift);
}

TEST(ShadowedExchange, WhatHidesTwiceHidesOnce) {
  const Rectangle plate{0, 0.5, 0, 0.5};
  const std::optional<ShadowedArea> once = opposed({plate}, 0.5, 1e-4),
                                    twice = opposed({plate, plate}, 0.5, 1e-4);
  ASSERT_TRUE(once && twice);
  EXPECT_NEAR(twice->G, once->G, 1e-12);
}

TEST(ShadowedExchange, WhatStandsBesideOrBehindHidesNothing) {
  const std::optional<ShadowedArea> found =
      past(sampled(closed_forms::horizontal(kUnit, 0)),
           sampled(closed_forms::reversed(closed_forms::horizontal(kUnit, 1))),
           {closed_forms::horizontal({1.1, 2, 0, 1}, 0.5), closed_forms::horizontal({-1, 2, -1, 2}, 1.5),
            closed_forms::horizontal({-1, 2, -1, 2}, -0.5)},
           1e-6);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->G, closed_forms::opposed_rectangles(1, 1, 1), found->error);
}

TEST(ShadowedExchange, NoLightBetweenPlatesThatTouch) {
  const std::optional<ShadowedArea> found =
      opposed({{-1, 1.0 / 3, -1, 2}, {1.0 / 3, 2, -1, 0.7}, {1.0 / 3, 2, 0.7, 2}}, 0.5, 1e-6);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->G, 0);
}

TEST(ShadowedExchange, TooManyAreLeftToRays) {
  EXPECT_TRUE(opposed(std::vector<Rectangle>(kMaxShadows, {2, 3, 0, 1}), 0.5, 1e-3));
  EXPECT_FALSE(opposed(std::vector<Rectangle>(kMaxShadows + 1, {2, 3, 0, 1}), 0.5, 1e-3));
}

// Up to four triangles anywhere between a square and a triangle.
TEST(ShadowedExchange, AgreesWithRays) {
  std::mt19937 random(3);
  int compared = 0;
  for (int k = 0; k < 40; ++k) {
    const closed_forms::Polygon square = closed_forms::horizontal(kUnit, 0);
    closed_forms::Polygon target;
    for (int c = 0; c < 3; ++c)
      target.push_back(glm::dvec3(0, 0, 1.5) + test_scenes::uniform_point(random, -0.4, 1.4));
    if (area_vector(target).z > 0) std::ranges::reverse(target);
    const SampledPolygon Q = sampled(target);
    const SmallPolygon in_front = clip_to_front(square, {target[0], Q.normal});
    if (in_front.size() < 3) continue;
    const SampledPolygon P{in_front, {0, 0, 1}};
    std::vector<closed_forms::Polygon> occluders;
    Scene scene = by_hand::empty_scene(Sides::one);
    for (int count = 0; count <= k % 4; ++count) {
      closed_forms::Polygon triangle;
      for (int c = 0; c < 3; ++c)
        triangle.push_back(glm::dvec3(0, 0, 0.5) +
                           glm::dvec3(1, 1, 0.5) * test_scenes::uniform_point(random, -0.5, 1.5));
      occluders.push_back(triangle);
      by_hand::add(scene, "occluder", triangle);
    }
    scene = test_scenes::finished(std::move(scene));
    const RayScene ray_scene(scene, 1);
    const FractionEstimate by_rays = estimate_fraction(ray_scene, P, Q, 7, 1e-4);
    const double free = exchange_area_by_contour(corners(P.corners), corners(Q.corners), ContourPoints::fine);
    const std::optional<ShadowedArea> found = past(P, Q, occluders, 1e-5 * free);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->G, free * by_rays.value, 4 * free * (by_rays.error + 2e-5) + found->error) << k;
    compared += by_rays.value > 0.01 && by_rays.value < 0.99 ? 1 : 0;
  }
  EXPECT_GT(compared, 15);
}

TEST(OccludingPatches, SquaresOfAWallAreOneWhateverTheirGroups) {
  SceneInput input;
  input.materials = {{"black", Rgb(0), Rgb(0), std::nullopt, std::nullopt}};
  const auto add = [&](const closed_forms::Polygon& wall) {
    const glm::dvec3 u = (wall[1] - wall[0]) / 3.0, v = (wall[3] - wall[0]) / 3.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const glm::dvec3 at = wall[0] + double(i) * u + double(j) * v;
        input.polygons.push_back({{at, at + u, at + u + v, at + v},
                                  MaterialId{0},
                                  GroupId{static_cast<std::uint32_t>(input.groups.size())}});
        input.groups.push_back("square " + std::to_string(input.groups.size()));
      }
  };
  for (const closed_forms::Polygon& wall : closed_forms::reversed(closed_forms::cube(glm::dvec3(0), 3)))
    add(wall);
  const SceneSettings settings{Sides::one, KeMeaning::exitance, true, std::nullopt};
  EXPECT_TRUE(occluding_patches(build_scene(input, settings)).patches.empty()) << "a convex room";
  for (const closed_forms::Polygon& wall : closed_forms::cube(glm::dvec3(0), 1)) add(wall);
  const Scene scene = build_scene(input, settings), occluders = occluding_patches(scene);
  EXPECT_EQ(scene.patches.size(), 108u);
  ASSERT_EQ(occluders.patches.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(occluders.patches[k].area, k < 6 ? 9 : 1, 1e-12);
}

}  // namespace
}  // namespace fluxel
