#include <gtest/gtest.h>

#include <bit>

#include "tests/unit/test_scenes.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {
namespace {

using test_scenes::finished;
using test_scenes::random_plates;
using test_scenes::uniform_elements;

/// Shortcuts must not change a bit, on scenes where they are at their limits.
struct Comparison {
  std::size_t facing = 0, rays = 0, visible = 0, different = 0;
};

Comparison compare(const Scene& scene, const std::vector<Element>& elements) {
  const RayScene ray_scene(scene, 1);
  const TileTracer quick(ray_scene, elements), slow(ray_scene, elements, Shortcuts::off);
  Comparison result;
  for (std::size_t row = 0; row < tile_count(elements.size()); ++row) {
    for (std::size_t column = row; column < tile_count(elements.size()); ++column) {
      const TracedTile a = quick.trace(row, column), b = slow.trace(row, column);
      EXPECT_EQ(a.tag, b.tag);
      result.facing += b.rays;
      result.rays += a.rays;
      for (std::size_t r = 0; r < kTileSize; ++r) {
        result.visible += static_cast<std::size_t>(std::popcount(b.bits[r]));
        result.different += static_cast<std::size_t>(std::popcount(a.bits[r] ^ b.bits[r]));
      }
    }
  }
  return result;
}

/// `most_rays`: of the pairs that face each other, so that a test whose pairs are all traced can't pass.
void expect_same_bits(const Scene& scene, double max_edge, double most_rays) {
  const std::vector<Element> elements = uniform_elements(scene, max_edge).elements;
  const Comparison result = compare(scene, elements);
  EXPECT_EQ(result.different, 0u) << "of " << result.facing;
  EXPECT_GT(result.visible, 1000u);
  EXPECT_GT(result.facing, result.visible / 2 + 1000);
  EXPECT_LT(static_cast<double>(result.rays), most_rays * static_cast<double>(result.facing));
}

void add_room(Scene& scene, const glm::dvec3& size) {
  by_hand::add_box(scene, "room", -0.5 * size, 0.5 * size, false);
}

TEST(Shortcuts, RandomPlates) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    expect_same_bits(random_plates(40, 0.6, Sides::one, seed), 0.15, 0.1);
    expect_same_bits(random_plates(25, 0.8, Sides::two, seed), 0.2, 0.2);
  }
}

TEST(Shortcuts, SmallPlatesOfManyPatches) {
  // A patch an element: clusters are boxes, lists are too long, and rays have to do it.
  expect_same_bits(random_plates(1500, 0.1, Sides::one, 4), 1, 1.01);
}

// Centroids, corners and planes stand on one lattice: rays run along edges, in planes and through corners.
TEST(Shortcuts, CubesOnALattice) {
  for (const Sides sides : {Sides::one, Sides::two}) {
    Scene scene = by_hand::empty_scene(sides);
    add_room(scene, glm::dvec3(4));
    for (const double x : {-1.0, 0.0, 1.0})
      for (const double y : {-1.0, 0.0, 1.0})
        for (const double z : {-1.5, -0.5, 0.5})
          by_hand::add_box(scene, "cube", {x - 0.25, y - 0.25, z - 0.25}, {x + 0.25, y + 0.25, z + 0.25},
                           true);
    expect_same_bits(finished(std::move(scene)), 0.25, 0.6);
  }
}

TEST(Shortcuts, BoxesThatTouch) {
  Scene scene = by_hand::empty_scene(Sides::one);
  add_room(scene, {4, 3, 2});
  // On the floor, on each other, side by side, edge to edge and in a corner of the room.
  by_hand::add_box(scene, "standing", {-1, -1, -1}, {0, 0, 0}, true);
  by_hand::add_box(scene, "on top", {-0.75, -0.75, 0}, {-0.25, -0.25, 0.5}, true);
  by_hand::add_box(scene, "beside", {0, -1, -1}, {0.5, 0, -0.5}, true);
  by_hand::add_box(scene, "edge to edge", {0.5, 0, -1}, {1, 0.5, 0}, true);
  by_hand::add_box(scene, "corner", {1.5, 1, -1}, {2, 1.5, 0.5}, true);
  scene = finished(std::move(scene));
  expect_same_bits(scene, 0.2, 0.1);
  by_hand::rotate(scene, glm::angleAxis(0.3, glm::normalize(glm::dvec3(1, 2, 3))));
  for (Piece& piece : scene.pieces) piece.outline = scene.patch(piece.patch).outline;
  expect_same_bits(scene, 0.2, 0.2);
}

TEST(Shortcuts, SheetsNearlyTogether) {
  for (const double gap : {0.0, 1e-7, 3e-6, 1e-5, 1e-4, 1e-2}) {
    for (const Sides sides : {Sides::one, Sides::two}) {
      Scene scene = by_hand::empty_scene(sides);
      add_room(scene, glm::dvec3(2));
      for (const double z : {0.0, gap, 2 * gap})
        by_hand::add(scene, "sheet", {{-0.5, -0.5, z}, {0.5, -0.5, z}, {0.5, 0.5, z}, {-0.5, 0.5, z}});
      expect_same_bits(finished(std::move(scene)), 0.2, 0.6);
    }
  }
}

TEST(Shortcuts, Slivers) {
  std::mt19937 random(7);
  Scene scene = by_hand::empty_scene(Sides::two);
  for (int k = 0; k < 150; ++k) {
    const glm::dvec3 at = test_scenes::uniform_point(random, -1, 1);
    const glm::dvec3 along = test_scenes::random_direction(random);
    const double width = std::pow(10.0, -1 - 3 * test_scenes::uniform(random, 0, 1));
    const glm::dvec3 across =
        width * glm::normalize(glm::cross(along, test_scenes::random_direction(random)));
    by_hand::add(scene, "sliver", {at, at + along, at + 0.3 * along + across});
  }
  expect_same_bits(finished(std::move(scene)), 0.3, 0.9);
}

// Elements of a far wall look along the floor through gaps that are narrow against the distance.
TEST(Shortcuts, GrazingRaysOverALongFloor) {
  Scene scene = by_hand::empty_scene(Sides::one);
  add_room(scene, {200, 2, 1});
  for (int k = -9; k < 10; ++k)
    by_hand::add_box(scene, "kerb", {10.0 * k, -1, -0.5}, {10.0 * k + 0.01, 1, -0.5 + 0.001 * (10 + k)},
                     true);
  expect_same_bits(finished(std::move(scene)), 1.7, 0.4);
}

TEST(Shortcuts, EveryScale) {
  for (const double scale : {1e-3, 1e3}) {
    Scene scene = random_plates(40, 0.6, Sides::one, 5);
    for (Patch& patch : scene.patches) {
      for (glm::dvec3& x : patch.outline.corner) x = scale * (x + glm::dvec3(3, -2, 1));
      patch.area *= scale * scale;
    }
    scene.pieces.clear();
    expect_same_bits(finished(std::move(scene)), 0.15 * scale, 0.2);
  }
}

TEST(Shortcuts, ScenesOfTheProject) {
  struct Case {
    const char* name;
    double max_edge, most_rays;
  };
  for (const Case& one : {Case{"cornell-box", 0.1, 0.05}, Case{"construction-in-wood", 0.5, 0.2},
                          Case{"office-2391", 0.7, 0.95}}) {
    SCOPED_TRACE(one.name);
    expect_same_bits(test_scenes::load(one.name, 8, 8).scene, one.max_edge, one.most_rays);
  }
}

}  // namespace
}  // namespace fluxel
