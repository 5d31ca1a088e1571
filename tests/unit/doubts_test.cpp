#include "scene/doubts.hpp"

#include <gtest/gtest.h>

#include "tests/unit/messages.hpp"
#include "tests/unit/scene_by_hand.hpp"

namespace fluxel::doubts_test {
namespace {

using by_hand::add;
using test_messages::expect_words;

Scene square() {
  Scene scene = by_hand::empty_scene(Sides::two);
  add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  scene.statistics.closed = true;
  return scene;
}

TEST(Doubts, NoneOfASoundScene) { EXPECT_TRUE(doubts_of(square()).empty()); }

TEST(Doubts, EachKindIsASentence) {
  Scene scene = square();
  scene.statistics.closed = false;
  scene.statistics.flipped_edges = 1;
  scene.statistics.boundary_edges = 4;
  scene.statistics.nonmanifold_edges = 2;
  scene.statistics.coplanar_overlaps = 3;
  scene.statistics.covered_area = 0.25;
  scene.statistics.degenerate_faces = 5;
  scene.materials[0].rho = Rgb(0.5, 0.96, 0.5);
  const std::vector<std::string> doubts = doubts_of(scene);
  ASSERT_EQ(doubts.size(), 6u);
  expect_words(doubts[0], {"1 edge joins two patches", "opposite ways"});
  expect_words(doubts[1], {"4 edges belong to one patch alone", "gap"});
  expect_words(doubts[2], {"2 edges belong to more than two patches"});
  expect_words(doubts[3], {"3 pairs of patches overlap in one plane", "0.25 m2"});
  expect_words(doubts[4], {"5 faces are dropped"});
  expect_words(doubts[5], {"above 0.95", "white"});
}

TEST(Doubts, FreeEdgesOfAClosedSceneAreNoGaps) {
  Scene scene = square();
  scene.statistics.boundary_edges = 4;
  EXPECT_TRUE(doubts_of(scene).empty());
}

TEST(Doubts, SurfacesOfHeatMayReflectNearlyAll) {
  Scene scene = square();
  scene.materials[0].rho = Rgb(1);
  scene.materials[0].thermal = ThermalSurface{};
  EXPECT_TRUE(doubts_of(scene).empty());
}

TEST(Doubts, MaterialsThatNoFaceHasDoNotCount) {
  Scene scene = square();
  scene.materials[1].rho = Rgb(1);
  EXPECT_TRUE(doubts_of(scene).empty());
}

}  // namespace
}  // namespace fluxel::doubts_test
