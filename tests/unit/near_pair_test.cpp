#include "formfactor/near_pair.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include "formfactor/exchange.hpp"
#include "formfactor/pair_rule.hpp"
#include "scene/occluding_patches.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// Two patches and what stands between, an element each, and an even light of 1.
struct Pair {
  Scene scene;
  ElementMesh mesh;
  RayScene ray_scene;
  PowerEstimate power;
  FormFactorOptions options;
  CorrectionCounts counts;

  Pair(Sides sides, const Polygon& first, const Polygon& second, const std::vector<Polygon>& between = {})
      : scene(make(sides, first, second, between)),
        mesh(test_scenes::uniform_elements(scene, 100)),
        ray_scene(scene, 1) {
    EXPECT_EQ(mesh.elements.size(), 2 + between.size());
    EXPECT_EQ(mesh.elements[0].patch, PatchId{0});
    EXPECT_EQ(mesh.elements[1].patch, PatchId{1});
    power.B.assign(2 * mesh.elements.size(), 1);
    power.H = power.B;
  }

  SideExchanges exchange(bool near, bool sees) {
    const OcclusionScene occlusion(ray_scene, occluding_patches(scene),
                                   static_cast<double>(ray_scene.surface_epsilon()));
    const Box all{glm::dvec3(-scene.extent), glm::dvec3(scene.extent)};
    TileOccluders occluders(occlusion, mesh, all, all);
    return PairExaminer(occlusion, scene, mesh, options, power).exchange(0, 1, near, sees, occluders, counts);
  }

 private:
  static Scene make(Sides sides, const Polygon& first, const Polygon& second,
                    const std::vector<Polygon>& between) {
    Scene made = by_hand::empty_scene(sides);
    by_hand::add(made, "first", first);
    by_hand::add(made, "second", second);
    for (const Polygon& polygon : between) by_hand::add(made, "between", polygon);
    return test_scenes::finished(std::move(made));
  }
};

const Polygon kFloor{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const Polygon kWall{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
const Polygon kCrossing{{1.5, 0, -0.4}, {1.5, 1, -0.4}, {1.5, 1, 0.6}, {1.5, 0, 0.6}};

TEST(NearPair, AWallOnAFloor) {
  Pair pair(Sides::one, kFloor, kWall);
  const SideExchanges found = pair.exchange(true, true);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].side_i, 0u);
  EXPECT_EQ(found[0].side_j, 0u);
  EXPECT_NEAR(found[0].G, closed_forms::adjacent_rectangles(1, 1, 1), 3e-5);
}

TEST(NearPair, FarPairsAreTheMomentsRule) {
  Pair pair(Sides::one, kFloor, kWall);
  const SideExchanges found = pair.exchange(false, true);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_DOUBLE_EQ(found[0].G,
                   pair_form_factor(PairRule::moments, pair.mesh.elements[0], pair.mesh.elements[1]));
}

TEST(NearPair, TheBitDecidesWithoutPartialVisibility) {
  Pair pair(Sides::one, kFloor, kWall);
  pair.options.partial_visibility = false;
  const SideExchanges hidden = pair.exchange(true, false);
  ASSERT_EQ(hidden.size(), 1u);
  EXPECT_EQ(hidden[0].G, 0);
  EXPECT_EQ(pair.counts.rays, 0u);
  pair.options.partial_visibility = true;
  EXPECT_GT(pair.exchange(true, false)[0].G, 0.1) << "nothing stands between";
}

/// A shelf above the floor that hides half of a ceiling from it; shelves that together hide as much.
std::vector<Polygon> shelves(int count) {
  std::vector<Polygon> between;
  for (int k = 0; k < count; ++k)
    between.push_back(closed_forms::horizontal({double(k) / count, (k + 0.5) / count, 0, 1}, 2));
  return between;
}

TEST(NearPair, ShadowsOfAFewOccludersAreClippedWhereTheShareIsLarge) {
  constexpr closed_forms::Rectangle kUnit{0, 1, 0, 1};
  const Polygon ceiling = closed_forms::reversed(closed_forms::horizontal(kUnit, 4));
  const double half = closed_forms::opposed_rectangles(1, 1, 4) / 2;
  Pair pair(Sides::one, kFloor, ceiling, shelves(1));
  const SideExchanges clipped = pair.exchange(true, true);
  ASSERT_EQ(clipped.size(), 1u);
  EXPECT_NEAR(clipped[0].G, half, error_at_an_edge(kMaxPairRays) * half);
  EXPECT_EQ(pair.counts.rays, 0u);
  EXPECT_EQ(pair.counts.clipped_pairs, 1u);
  EXPECT_EQ(pair.counts.partial_pairs, 1u);

  // Worth less than the rays that an occluder costs.
  pair.counts = {};
  pair.options.tolerance = 2 * half / (2 * kRayTolerance * std::pow(0.9 * kRaysOfAnOccluder, 2.0 / 3));
  EXPECT_NEAR(pair.exchange(true, true)[0].G, half, 0.1 * half);
  EXPECT_GT(pair.counts.rays, 0u);
  EXPECT_EQ(pair.counts.clipped_pairs, 0u);

  Pair past_many(Sides::one, kFloor, ceiling, shelves(kMaxClippedOccluders + 1));
  past_many.options.tolerance = 1e-5;
  EXPECT_NEAR(past_many.exchange(true, true)[0].G, half, 0.1 * half);
  EXPECT_EQ(past_many.counts.clipped_pairs, 0u);
  EXPECT_GE(past_many.counts.rays, std::uint64_t{kMaxPairRays});
}

// A box stands on the middle of a floor's elements, another leans on a wall: what they hide, as far as it is
// clipped, is what many rays find.
TEST(NearPair, ClippedShadowsAreThoseOfManyRays) {
  Scene made = by_hand::empty_scene(Sides::one);
  by_hand::add_box(made, "room", {0, 0, 0}, {3, 2, 2}, false);
  by_hand::add_box(made, "standing", {1.3, 0.8, 0}, {1.7, 1.3, 0.9}, true);
  by_hand::add_box(made, "leaning", {0, 0.2, 0.5}, {0.3, 0.9, 1.1}, true);
  const Scene scene = test_scenes::finished(std::move(made));
  const ElementMesh mesh = test_scenes::uniform_elements(scene, 0.5);
  const RayScene ray_scene(scene, 1);
  const auto epsilon = static_cast<double>(ray_scene.surface_epsilon());
  const OcclusionScene occlusion(ray_scene, occluding_patches(scene), epsilon);
  const PowerEstimate power{std::vector<double>(mesh.elements.size(), 1),
                            std::vector<double>(mesh.elements.size(), 1)};
  FormFactorOptions options;
  options.tolerance = 1e-4;
  const PairExaminer examiner(occlusion, scene, mesh, options, power);
  const Box all{glm::dvec3(-scene.extent), glm::dvec3(scene.extent)};
  std::size_t partly = 0, outliers = 0;
  double sum = 0, sum_by_rays = 0;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    TileOccluders occluders(occlusion, mesh, all, all);
    for (std::size_t j = i + 1; j < mesh.elements.size(); ++j) {
      if (mesh.elements[i].patch == mesh.elements[j].patch) continue;
      CorrectionCounts counts;
      const SideExchanges found = examiner.exchange(i, j, true, true, occluders, counts);
      if (counts.clipped_pairs == 0) continue;
      const auto facing = [&](std::size_t of, std::size_t from) {
        const Outline<glm::dvec3> outline = widen(mesh.outlines[of]);
        const glm::dvec3 normal = scene.patch(mesh.elements[from].patch).normal;
        return SampledPolygon{
            clip_to_front(corners(outline), {glm::dvec3(mesh.elements[from].centroid), normal}, epsilon),
            scene.patch(mesh.elements[of].patch).normal};
      };
      const SampledPolygon P = facing(i, j), Q = facing(j, i);
      const double free = free_exchange(P, Q, 1e-9).G;
      const FractionEstimate by_rays = estimate_fraction(ray_scene, P, Q, i << 16 | j, 1e-3);
      const double difference = std::abs(found[0].G - free * by_rays.value) / free;
      EXPECT_LT(difference, 0.02 + 5 * by_rays.error) << i << ' ' << j;
      outliers += difference > error_at_an_edge(kMaxPairRays) + 3 * by_rays.error ? 1 : 0;
      sum += found[0].G;
      sum_by_rays += free * by_rays.value;
      partly += counts.partial_pairs;
    }
  }
  EXPECT_GT(partly, 100u);
  EXPECT_LE(outliers, partly / 50) << "two rules that agree by chance";
  EXPECT_NEAR(sum, sum_by_rays, 5e-4 * sum_by_rays) << "no bias";
}

TEST(NearPair, ElementsOfOnePlaneExchangeNothing) {
  Pair pair(Sides::two, kFloor, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  EXPECT_TRUE(pair.exchange(true, true).empty());
}

TEST(NearPair, BacksOfOneSidedElementsDoNotCount) {
  Pair pair(Sides::one, kFloor, Polygon(kWall.rbegin(), kWall.rend()));
  EXPECT_TRUE(pair.exchange(true, true).empty());
}

// The upper part of the second is seen by the first's front, the lower by its back.
TEST(NearPair, EachPartOfACrossingElementHasItsSide) {
  Pair pair(Sides::two, kFloor, kCrossing);
  const SideExchanges found = pair.exchange(true, true);
  ASSERT_EQ(found.size(), 2u);
  const auto exact = [](double height) {
    return closed_forms::perpendicular_rectangles({0.5, 1.5, 0, 1}, {0, height, 0, 1});
  };
  const std::uint32_t towards_floor = area_vector(kCrossing).x < 0 ? 0 : 1;
  for (const SideExchange& side : found) {
    EXPECT_EQ(side.side_j, towards_floor);
    EXPECT_NEAR(side.G, exact(side.side_i == 0 ? 0.6 : 0.4), 1e-5);
  }
}

// Each crosses the other's plane, so that both sides of each see something of the other.
TEST(NearPair, PartsOfACrossingPairAddUpNearAndFar) {
  const Polygon beside{{0.6, 1.5, -0.4}, {0.6, 2.5, -0.4}, {0.6, 2.5, 0.5}, {0.6, 1.5, 0.5}};
  const auto seen_from = [](const Polygon& polygon, std::uint32_t side) {
    return side == 0 ? polygon : closed_forms::reversed(polygon);
  };
  Pair pair(Sides::two, kFloor, beside);
  pair.options.tolerance = 1e-5;
  for (const bool near : {true, false}) {
    const SideExchanges found = pair.exchange(near, true);
    ASSERT_EQ(found.size(), 4u);
    double sum = 0, exact_sum = 0;
    for (const SideExchange& side : found) {
      const double exact =
          closed_forms::exchange_area(seen_from(kFloor, side.side_i), seen_from(beside, side.side_j));
      EXPECT_GT(exact, 0.0005);
      EXPECT_NEAR(side.G, exact, 1e-6) << near << side.side_i << side.side_j;
      sum += side.G;
      exact_sum += exact;
    }
    EXPECT_NEAR(sum, exact_sum, 2e-6) << near;
  }
}

}  // namespace
}  // namespace fluxel
