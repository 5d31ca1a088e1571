#include "scene/closedness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "scene_by_hand.hpp"

namespace fluxel {
namespace {

using namespace by_hand;

bool closed(const Scene& scene) { return is_closed(scene, connect_patches(scene)); }

/// A room of 4 x 4 x 3 m, its faces inward.
Scene closed_room() {
  Scene scene = empty_scene(Sides::two);
  add_box(scene, "room", {0, 0, 0}, {4, 4, 3}, false);
  return scene;
}

TEST(Closedness, ARoomIsClosedUntilAWallIsTakenOut) {
  Scene scene = closed_room();
  EXPECT_TRUE(closed(scene));
  scene.patches.pop_back();
  EXPECT_FALSE(closed(scene));
}

TEST(Closedness, WhatHangsOrStandsInARoomDoesNotOpenIt) {
  std::mt19937 random(7);
  Scene scene = closed_room();
  add(scene, "panel", {{1, 1, 2}, {2, 1, 2}, {2, 2, 2.5}, {1, 2, 2.5}});
  EXPECT_TRUE(closed(scene));
  add(scene, "shelf", {{0, 1, 1}, {0, 2, 1}, {0.5, 2, 1}, {0.5, 1, 1}});       // an edge on a wall
  add(scene, "partition", {{2, 0, 0}, {2, 4, 0}, {2, 4, 3}, {2, 0, 3}});       // from wall to wall
  add(scene, "picture", {{4, 1, 1}, {4, 2, 1}, {4, 2, 2}, {4, 1, 2}});         // on a wall
  add(scene, "carpet", {{1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}}, kLight);  // on the floor
  add_box(scene, "cupboard", {1, 3, 0}, {2, 4, 2}, true);
  EXPECT_TRUE(closed(scene));
  for (int repeat = 0; repeat < 20; ++repeat) {
    rotate(scene, random_rotation(random));
    EXPECT_TRUE(closed(scene)) << repeat;
  }
}

TEST(Closedness, WhatStandsOutsideOrReachesOutIsOpen) {
  for (const double x : {-0.5, 3.5, 5.0}) {
    Scene scene = closed_room();
    add(scene, "panel", {{x, 1, 1}, {x + 1, 1, 1}, {x + 1, 2, 1}, {x, 2, 1}});
    EXPECT_FALSE(closed(scene)) << x;
  }
}

TEST(Closedness, TwoRoomsApartAreClosedEachWithItsPanel) {
  Scene scene = closed_room();
  add_box(scene, "other", {6, 0, 0}, {8, 2, 2}, false);
  add(scene, "panel", {{1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}});
  add(scene, "panel", {{6.5, 0.5, 1}, {7, 0.5, 1}, {7, 1, 1}, {6.5, 1, 1}});
  EXPECT_TRUE(closed(scene));
  add(scene, "between", {{4.5, 0.5, 1}, {5, 0.5, 1}, {5, 1, 1}, {4.5, 1, 1}});
  EXPECT_FALSE(closed(scene));
}

/// A closed L of two arms around a bay, 1 m high; with its corner's floor and ceiling turned over there is no
/// winding number to tell by.
Scene angle(bool turned) {
  Scene scene = empty_scene(Sides::two);
  const std::vector<glm::dvec2> outline = {{0, 0}, {2, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}, {0, 2}};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    add(scene, "L", {{a, 0}, {b, 0}, {b, 1}, {a, 1}});
  }
  for (const glm::dvec2 low : {glm::dvec2(0, 0), glm::dvec2(2, 0), glm::dvec2(0, 2)}) {
    const glm::dvec2 high = low + 2.0;
    std::vector<glm::dvec3> ceiling = {{low, 1}, {high.x, low.y, 1}, {high, 1}, {low.x, high.y, 1}};
    std::vector<glm::dvec3> floor = {{low, 0}, {low.x, high.y, 0}, {high, 0}, {high.x, low.y, 0}};
    if (turned && low == glm::dvec2(0)) {
      std::ranges::reverse(ceiling);
      std::ranges::reverse(floor);
    }
    add(scene, "L", ceiling);
    add(scene, "L", floor);
  }
  return scene;
}

TEST(Closedness, ABayIsOutside) {
  for (const bool turned : {false, true}) {
    for (const double x : {1.0, 3.0}) {
      Scene scene = angle(turned);
      EXPECT_EQ(connect_patches(scene).components[0].oriented, !turned);
      EXPECT_TRUE(closed(scene));
      add(scene, "panel", {{x, x, 0.5}, {x + 0.2, x, 0.5}, {x + 0.2, x + 0.2, 0.5}, {x, x + 0.2, 0.5}});
      EXPECT_EQ(closed(scene), x < 2) << turned;
    }
  }
}

// From the bottom of a deep well hardly a direction leads out, but it is not within the block.
TEST(Closedness, AWellIsOutside) {
  Scene scene = empty_scene(Sides::two);
  add_box(scene, "block", {0, 0, 0}, {4, 4, 4}, true);
  std::erase_if(scene.patches, [](const Patch& patch) { return patch.normal.z > 0.5; });
  const std::vector<glm::dvec2> outer = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const std::vector<glm::dvec2> inner = {{1.9, 1.9}, {2.1, 1.9}, {2.1, 2.1}, {1.9, 2.1}};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    add(scene, "top", {{outer[i], 4}, {outer[next], 4}, {inner[next], 4}, {inner[i], 4}});
    add(scene, "well", {{inner[i], 4}, {inner[next], 4}, {inner[next], 0.5}, {inner[i], 0.5}});
  }
  add(scene, "well", {{inner[0], 0.5}, {inner[1], 0.5}, {inner[2], 0.5}, {inner[3], 0.5}});
  ASSERT_TRUE(connect_patches(scene).components[0].oriented);
  EXPECT_TRUE(closed(scene));
  add(scene, "panel", {{1.95, 1.95, 0.7}, {2.05, 1.95, 0.7}, {2.05, 2.05, 0.7}, {1.95, 2.05, 0.7}});
  EXPECT_FALSE(closed(scene));
}

}  // namespace
}  // namespace fluxel
