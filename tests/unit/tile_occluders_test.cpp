#include "formfactor/tile_occluders.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

bool is_in(std::span<const PatchId> list, PatchId id) { return std::ranges::find(list, id) != list.end(); }

/// Two squares on a floor, x from 0 to 1 and from 9 to 10; a ceiling square above the first; a board over
/// each; one far beside.
TEST(TileOccluders, NarrowsTheListToWhatStandsBeforeAnElement) {
  Scene made = by_hand::empty_scene(Sides::one);
  const auto square = [](double x, double z) {
    return Polygon{{x, 0, z}, {x + 1, 0, z}, {x + 1, 1, z}, {x, 1, z}};
  };
  const Polygon ceiling = square(0, 3);
  by_hand::add(made, "first", square(0, 0));
  by_hand::add(made, "second", square(9, 0));
  by_hand::add(made, "ceiling", Polygon(ceiling.rbegin(), ceiling.rend()));
  by_hand::add(made, "over first", square(0, 1));
  by_hand::add(made, "over second", square(9, 0.1));
  by_hand::add(made, "beside", square(0, 5));
  const Scene scene = test_scenes::finished(std::move(made));
  const ElementMesh mesh = test_scenes::uniform_elements(scene, 100);
  ASSERT_EQ(mesh.elements.size(), 6u);
  const RayScene ray_scene(scene, 1);
  const OcclusionScene occlusion(ray_scene, scene, 1e-6);
  const auto box_of = [&](std::size_t first, std::size_t last) {
    std::vector<glm::dvec3> points;
    for (std::size_t i = first; i < last; ++i) {
      const Outline<glm::dvec3> outline = widen(mesh.outlines[i]);
      points.insert(points.end(), corners(outline).begin(), corners(outline).end());
    }
    return bounds(points);
  };

  TileOccluders occluders(occlusion, mesh, box_of(0, 2), box_of(2, 3));
  for (int again = 0; again < 2; ++again) {
    const auto of_first = occluders.candidates(0).value();
    EXPECT_TRUE(is_in(of_first, PatchId{3}));
    EXPECT_FALSE(is_in(of_first, PatchId{4}));
    EXPECT_FALSE(is_in(of_first, PatchId{5}));
    const auto of_second = occluders.candidates(1).value();
    EXPECT_FALSE(is_in(of_second, PatchId{3}));
    EXPECT_TRUE(is_in(of_second, PatchId{4}));
    EXPECT_TRUE(std::ranges::equal(of_second, occluders.candidates(1).value()));
  }
}

TEST(TileOccluders, GivesUpWhereTooManyStandBetween) {
  for (const std::size_t many : {TileOccluders::kMostCandidates, TileOccluders::kMostCandidates + 1}) {
    Scene made = by_hand::empty_scene(Sides::one);
    for (std::size_t k = 0; k < many; ++k) {
      const double z = static_cast<double>(k + 1) / static_cast<double>(many + 1);
      by_hand::add(made, "shelf", {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}});
    }
    const Scene scene = test_scenes::finished(std::move(made));
    const ElementMesh mesh = test_scenes::uniform_elements(scene, 100);
    const RayScene ray_scene(scene, 1);
    const OcclusionScene occlusion(ray_scene, scene, 1e-6);
    TileOccluders occluders(occlusion, mesh, {{0, 0, 0}, {1, 1, 0}}, {{0, 0, 1}, {1, 1, 1}});
    EXPECT_EQ(occluders.candidates(0).has_value(), many == TileOccluders::kMostCandidates);
    EXPECT_EQ(occluders.candidates(1).has_value(), many == TileOccluders::kMostCandidates);
  }
}

TEST(TileOccluders, AConvexSceneHasNone) {
  Scene made = by_hand::empty_scene(Sides::one);
  by_hand::add_box(made, "box", {0, 0, 0}, {1, 1, 1}, false);
  const Scene scene = test_scenes::finished(std::move(made));
  const ElementMesh mesh = test_scenes::uniform_elements(scene, 100);
  const RayScene ray_scene(scene, 1);
  const OcclusionScene occlusion(ray_scene, Scene{}, 1e-6);
  const Box box{glm::dvec3(0), glm::dvec3(1)};
  TileOccluders occluders(occlusion, mesh, box, box);
  EXPECT_TRUE(occluders.candidates(0).value().empty());
  EXPECT_TRUE(occluders.candidates(1).value().empty());
}

}  // namespace
}  // namespace fluxel
