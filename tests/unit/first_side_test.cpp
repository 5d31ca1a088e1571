#include "visibility/first_side.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

const std::vector<glm::dvec3> kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<glm::dvec3> kTurned{{0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0}};

MetSide from_above(const Scene& scene) {
  const RayScene ray_scene(scene, 1);
  return FirstSide(ray_scene).meet({0.4, 0.3, 2}, {0, 0, -1});
}

TEST(FirstSide, IsOfTheSideThatLooksBack) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "square", kSquare);
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const FirstSide first_side(ray_scene);
  const MetSide above = first_side.meet({0.4, 0.3, 2}, {0, 0, -1});
  EXPECT_TRUE(above.front && above.active);
  EXPECT_NEAR(above.t, 2, 1e-12);
  const MetSide below = first_side.meet({0.4, 0.3, -2}, {0, 0, 1});
  EXPECT_FALSE(below.front || below.active);
  EXPECT_EQ(first_side.meet({0.4, 0.3, 2}, {0, 0, 1}).patch, kNoPatch);
}

// Two sheets back to back: whichever Embree meets first, the side that is an unknown counts.
TEST(FirstSide, OfSheetsBackToBackTheActiveOneCounts) {
  for (const bool turned_first : {true, false}) {
    Scene scene = by_hand::empty_scene(Sides::one);
    by_hand::add(scene, "first", turned_first ? kTurned : kSquare);
    by_hand::add(scene, "second", turned_first ? kSquare : kTurned);
    const MetSide met = from_above(test_scenes::finished(std::move(scene)));
    EXPECT_TRUE(met.active);
    EXPECT_EQ(index(met.patch), turned_first ? 1U : 0U);
  }
}

// What lies on another patch has taken that area from it, but a ray may meet the other first.
TEST(FirstSide, WhatIsCoveredGivesWayToAnEmitter) {
  for (const bool light_first : {true, false}) {
    Scene scene = by_hand::empty_scene(Sides::one);
    for (const bool light : {light_first, !light_first})
      by_hand::add(scene, light ? "light" : "wall", kSquare, light ? by_hand::kLight : by_hand::kWhite);
    scene = test_scenes::finished(std::move(scene));
    const std::uint32_t light = light_first ? 0 : 1;
    std::erase_if(scene.pieces, [&](const Piece& piece) { return index(piece.patch) != light; });
    EXPECT_EQ(index(from_above(scene).patch), light);
  }
}

}  // namespace
}  // namespace fluxel
