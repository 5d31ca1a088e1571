#include "visibility/segment_test.hpp"

#include <gtest/gtest.h>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

const Patch& only_patch(const Scene& scene) { return scene.patches.front(); }

Scene square() {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "square", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  return scene;
}

TEST(SegmentTest, ALineThroughAnEdgeMeetsOneOfTheNeighbours) {
  Scene scene = by_hand::empty_scene(Sides::two);
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      by_hand::add(scene, "square", {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
  std::vector<int> met(4);
  for (int k = 0; k < 2000; ++k) {
    // Through points of the cross in the middle, its centre among them, and of the outer edge.
    const double s = 0.25 * (1 + k % 7);
    const glm::dvec3 at = k % 3 == 0 ? glm::dvec3(s, 1, 0) : glm::dvec3(1, s, 0);
    const glm::dvec3 up(0.25 * (k % 11), -0.125 * (k % 13), 1 + k % 5);
    int count = 0;
    for (std::size_t patch = 0; patch < 4; ++patch) {
      const bool meets = segment_meets(scene.patches[patch], at + up, at - up);
      EXPECT_EQ(ray_meets(scene.patches[patch], at + up, -2.0 * up), meets);
      met[patch] += meets ? 1 : 0;
      count += meets ? 1 : 0;
    }
    EXPECT_EQ(count, 1);
  }
  for (const int times : met) EXPECT_GT(times, 300);
}

TEST(SegmentTest, EndsHaveToLieOnDifferentSides) {
  const Scene scene = square();
  const glm::dvec3 above(0.5, 0.5, 1e-9), far(0.5, 0.5, 3), below(0.5, 0.5, -1e-9);
  EXPECT_FALSE(segment_meets(only_patch(scene), above, far));
  EXPECT_TRUE(segment_meets(only_patch(scene), far, below));
  EXPECT_FALSE(ray_meets(only_patch(scene), above, {0, 0, 1}));
  EXPECT_TRUE(ray_meets(only_patch(scene), far, {0, 0, -1}));
}

// Corners in single precision are no plane: what passes one face's edge has to meet the next face.
TEST(SegmentTest, NothingLeavesAClosedBox) {
  std::mt19937 random(3);
  int lost = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    Scene scene = by_hand::empty_scene(Sides::one);
    by_hand::add_box(scene, "box", {-1, -0.7, -0.4}, {1, 0.7, 0.4}, false);
    by_hand::rotate(scene, by_hand::random_rotation(random));
    for (int k = 0; k < 2000; ++k) {
      const glm::vec3 from(test_scenes::uniform_point(random, -0.1, 0.1));
      // Through a point of an edge, as near as single precision comes.
      const Outline<glm::dvec3>& face = scene.patches[random() % 6].outline;
      const std::size_t c = random() % 4;
      const double s = test_scenes::uniform(random, 0, 1);
      const glm::vec3 along(2.0 *
                            ((1 - s) * face.corner[c] + s * face.corner[(c + 1) % 4] - glm::dvec3(from)));
      const glm::dvec3 to = glm::dvec3(from) + glm::dvec3(along);
      lost += std::ranges::none_of(
          scene.patches, [&](const Patch& patch) { return segment_meets(patch, glm::dvec3(from), to); });
    }
  }
  EXPECT_EQ(lost, 0);
}

TEST(SegmentTest, EnlargedOutlinesHoldThePatchAndItsMargin) {
  const double extent = 2;
  for (const Patch& patch : test_scenes::random_plates(30, 0.5, Sides::one, 4).patches) {
    const Outline<glm::dvec3> larger = enlarged(patch, extent);
    for (std::uint32_t edge = 0; edge < larger.corners; ++edge) {
      const glm::dvec3 from = larger.corner[edge];
      const glm::dvec3 inward =
          glm::cross(patch.normal, glm::normalize(larger.corner[(edge + 1) % larger.corners] - from));
      double nearest = extent;
      for (std::uint32_t c = 0; c < larger.corners; ++c)
        nearest = std::min(nearest, glm::dot(inward, patch.outline.corner[c] - from));
      EXPECT_NEAR(nearest, 256 * 0x1p-24 * extent, 1e-9);
    }
  }
  const Scene needle = [] {
    Scene scene = by_hand::empty_scene(Sides::one);
    by_hand::add(scene, "needle", {{0, 0, 0}, {1, 0, 0}, {1, 1e-4, 0}});
    return scene;
  }();
  EXPECT_GT(enlarged(only_patch(needle), extent).corner[0].x, -1e-2);
  EXPECT_NEAR(outline_margin(only_patch(needle), extent), 0.02 * std::sqrt(0.5e-4), 1e-12);
  const auto margin_of_square = [extent](double side) {
    Scene scene = by_hand::empty_scene(Sides::one);
    by_hand::add(scene, "square", {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}});
    return outline_margin(only_patch(scene), extent);
  };
  EXPECT_NEAR(margin_of_square(1e-3), 0.02 * 1e-3, 1e-12);  // between both bounds
  EXPECT_NEAR(margin_of_square(1e-5), 24 * 0x1p-24 * extent, 1e-12);
}

}  // namespace
}  // namespace fluxel
