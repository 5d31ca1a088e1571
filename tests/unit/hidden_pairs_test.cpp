#include "formfactor/hidden_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "tests/unit/test_scenes.hpp"
#include "visibility/tile.hpp"

namespace fluxel {
namespace {

using test_scenes::uniform_elements;

/// Elements along the side of a square: one tile each.
constexpr std::size_t kAlong = 8;

Scene squares_and_sheet(double from) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "above", {{0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2}});
  by_hand::add(scene, "sheet", {{from, -1, 1}, {3, -1, 1}, {3, 2, 1}, {from, 2, 1}});
  return test_scenes::finished(std::move(scene));
}

/// Two squares of side 1, 2 m apart face to face, and between them a sheet that reaches from x = `from` to 3.
struct Room {
  Scene scene;
  ElementMesh mesh;
  BodyTree bodies;
  std::vector<HiddenPairs::TileCorners> tiles;

  explicit Room(double from)
      : scene(squares_and_sheet(from)), mesh(uniform_elements(scene, 1.0 / kAlong)), bodies(scene) {
    for (std::size_t tile = 0; tile < tile_count(mesh.elements.size()); ++tile)
      tiles.push_back(HiddenPairs::tile_corners(mesh, tile));
  }

  [[nodiscard]] HiddenPairs pairs() const { return {bodies, view_, tiles, 1e-7}; }
  /// Of all pairs of an element of the first square and one of the second, how many are hidden.
  [[nodiscard]] std::size_t hidden() const {
    HiddenPairs all = pairs();
    std::size_t count = 0;
    for (const std::size_t i : of_patch(0))
      for (const std::size_t j : of_patch(1)) count += all.hidden(i, j) ? 1 : 0;
    return count;
  }
  [[nodiscard]] std::vector<std::size_t> of_patch(std::size_t patch) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < mesh.elements.size(); ++i)
      if (index(mesh.elements[i].patch) == patch) found.push_back(i);
    return found;
  }

 private:
  ElementView view_ = mesh;
};

TEST(HiddenPairs, ASheetThatReachesPastAllHidesAll) {
  const Room room(-1);
  const std::size_t pairs = room.of_patch(0).size() * room.of_patch(1).size();
  EXPECT_GE(pairs, 256u);
  EXPECT_EQ(room.hidden(), pairs);
}

TEST(HiddenPairs, AnEdgeWithinAShaftHidesNothingOfIt) {
  // Column a of one square and b of the other span x from (a + b) / 16 to (a + b + 2) / 16 halfway.
  const Room room(6.0 / 16);
  ASSERT_EQ(room.of_patch(0).size(), kAlong * kAlong);
  std::size_t expected = 0;
  for (std::size_t a = 0; a < kAlong; ++a)
    for (std::size_t b = 0; b < kAlong; ++b) expected += a + b >= 6 ? kAlong * kAlong : 0;
  EXPECT_EQ(room.hidden(), expected);
}

TEST(HiddenPairs, WhatIsHiddenDoesNotDependOnThePairsBefore) {
  const Room room(0.4);
  HiddenPairs all = room.pairs();
  for (const std::size_t i : room.of_patch(0))
    for (const std::size_t j : room.of_patch(1)) {
      HiddenPairs fresh = room.pairs();
      EXPECT_EQ(all.hidden(i, j), fresh.hidden(i, j)) << i << ' ' << j;
    }
}

/// A box between the squares, whose faces each hide a part only.
TEST(HiddenPairs, ABodyHidesWhatItsFacesHideTogether) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "left", {{-2, -0.1, -0.1}, {-2, 0.1, -0.1}, {-2, 0.1, 0.1}, {-2, -0.1, 0.1}});
  by_hand::add(scene, "right", {{2, -0.1, -0.1}, {2, -0.1, 0.1}, {2, 0.1, 0.1}, {2, 0.1, -0.1}});
  by_hand::add_box(scene, "box", glm::dvec3(-0.3), glm::dvec3(0.3), true);
  // Turned about z by an eighth, so that an edge stands before the squares.
  for (std::size_t k = 2; k < scene.patches.size(); ++k) {
    const auto turned = [](const glm::dvec3& x) {
      return glm::dvec3(std::sqrt(0.5) * (x.x - x.y), std::sqrt(0.5) * (x.x + x.y), x.z);
    };
    Patch& patch = scene.patches[k];
    patch.normal = turned(patch.normal);
    for (std::size_t c = 0; c < patch.outline.corners; ++c)
      patch.outline.corner[c] = turned(patch.outline.corner[c]);
  }
  scene = test_scenes::finished(std::move(scene));
  const ElementMesh mesh = uniform_elements(scene, 1);
  const ElementView view = mesh;
  const BodyTree bodies(scene);
  ASSERT_EQ(bodies.bodies().size(), 3u) << "two squares and one body";
  std::vector<HiddenPairs::TileCorners> tiles{HiddenPairs::tile_corners(mesh, 0)};
  HiddenPairs pairs(bodies, view, tiles, 1e-7);
  ASSERT_EQ(index(mesh.elements[1].patch), 1u);
  EXPECT_TRUE(pairs.hidden(0, 1));
  // What lies on the body's own surface may be inside of it.
  EXPECT_FALSE(pairs.hidden(2, 3));
}

TEST(HiddenPairs, TilesAreHiddenWhereAllTheirPairsAre) {
  for (const double from : {-1.0, -1e-3, 0.1, 0.9}) {
    const Room room(from);
    ASSERT_EQ(room.of_patch(0).front(), 0u);
    ASSERT_EQ(room.of_patch(1).front(), kTileSize);
    EXPECT_EQ(room.pairs().hidden_tiles(0, 1), from < 0) << from;
  }
}

}  // namespace
}  // namespace fluxel
