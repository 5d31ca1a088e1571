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

void add(Comparison& sum, const Comparison& one) {
  sum.facing += one.facing;
  sum.rays += one.rays;
  sum.visible += one.visible;
  sum.different += one.different;
}

/// `most_rays`: of the pairs that face each other, so that a test whose pairs are all traced can't pass.
void expect_same(const Comparison& result, double most_rays) {
  EXPECT_EQ(result.different, 0u) << "of " << result.facing;
  EXPECT_GT(result.visible, 1000u);
  EXPECT_GT(result.facing, result.visible / 2 + 1000);
  EXPECT_LT(static_cast<double>(result.rays), most_rays * static_cast<double>(result.facing));
}

void expect_same_bits(const Scene& scene, double max_edge, double most_rays) {
  expect_same(compare(scene, uniform_elements(scene, max_edge).elements), most_rays);
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

/// Turns a finished scene around the origin.
void turn(Scene& scene, const glm::dquat& rotation) {
  by_hand::rotate(scene, rotation);
  scene.extent = 0;
  scene.pieces.clear();
  scene = finished(std::move(scene));
}

// Centroids, corners and planes stand on one lattice: rays run along edges, in planes and through corners.
TEST(Shortcuts, CubesOnALattice) {
  std::mt19937 random(11);
  for (const Sides sides : {Sides::one, Sides::two, Sides::one, Sides::one}) {
    Scene scene = by_hand::empty_scene(sides);
    add_room(scene, glm::dvec3(4));
    for (const double x : {-1.0, 0.0, 1.0})
      for (const double y : {-1.0, 0.0, 1.0})
        for (const double z : {-1.5, -0.5, 0.5})
          by_hand::add_box(scene, "cube", {x - 0.25, y - 0.25, z - 0.25}, {x + 0.25, y + 0.25, z + 0.25},
                           true);
    scene = finished(std::move(scene));
    expect_same_bits(scene, 0.25, 0.6);
    turn(scene, by_hand::random_rotation(random));
    expect_same_bits(scene, 0.45, 0.6);
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
  turn(scene, glm::angleAxis(0.3, glm::normalize(glm::dvec3(1, 2, 3))));
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

// Ends of rays lie within rounding of the next sheet's plane.
TEST(Shortcuts, StacksOfSheetsALiftApart) {
  std::mt19937 random(12);
  Comparison sum;
  for (int repeat = 0; repeat < 24; ++repeat) {
    Scene scene = by_hand::empty_scene(repeat % 2 == 0 ? Sides::one : Sides::two);
    const double half = test_scenes::uniform(random, 1, 2);
    add_room(scene, glm::dvec3(2 * half));
    const auto lift = static_cast<double>(RayScene(finished(scene), 1).surface_epsilon());
    for (int stack = 0; stack < 6; ++stack) {
      glm::dvec3 at = test_scenes::uniform_point(random, -0.8 * half, 0.8 * half);
      glm::dvec3 normal = test_scenes::random_direction(random);
      if (stack % 3 == 0) {  // on the floor
        normal = {0, 0, 1};
        at.z = -half + lift * test_scenes::uniform(random, 0.9, 2.1);
      }
      const double size = std::pow(10.0, test_scenes::uniform(random, -1, -0.2));
      const glm::dvec3 u = size * glm::normalize(glm::cross(normal, test_scenes::random_direction(random)));
      const glm::dvec3 v = glm::cross(normal, u);
      for (int k = 0; k < 3; ++k) {
        const double gap =
            stack % 2 == 0 ? test_scenes::uniform(random, 0.98, 1.02) : test_scenes::uniform(random, 0, 3);
        at += gap * lift * normal + (k == 1 ? 0.2 * u : glm::dvec3(0));
        by_hand::add(scene, "sheet", {at, at + u, at + u + v, at + v});
      }
    }
    scene = finished(std::move(scene));
    add(sum, compare(scene, uniform_elements(scene, 0.2).elements));
  }
  expect_same(sum, 0.9);
}

// Corners are rounded by as much as the patches' distance from each other.
TEST(Shortcuts, TinyPatchesFarFromTheOrigin) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    Scene scene = random_plates(60, 0.6, Sides::two, seed);
    for (Patch& patch : scene.patches) {
      for (glm::dvec3& x : patch.outline.corner) x = 1e-4 * x + glm::dvec3(0.9, -0.7, 0.8);
      patch.area *= 1e-8;
    }
    scene.pieces.clear();
    scene.extent = 0;
    // Less than a lift apart nothing has a side; the lift goes by the scene's size, so that it has to be
    // large in space and small in contact: patches alone, without a far corner.
    expect_same_bits(finished(std::move(scene)), 0.2e-4, 0.95);
  }
}

// From across the room Embree sees the planes of needles tilted by more than their height over the floor.
TEST(Shortcuts, NeedlesJustAboveTheFloor) {
  std::mt19937 random(13);
  Scene scene = by_hand::empty_scene(Sides::one);
  add_room(scene, {9, 9, 9});
  for (int k = 0; k < 200; ++k) {
    const double angle = test_scenes::uniform(random, 0, 6.28),
                 width = test_scenes::uniform(random, 3e-4, 3e-2);
    const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), across(-along.y, along.x, 0);
    const glm::dvec3 at(test_scenes::uniform(random, -4, 4), test_scenes::uniform(random, -4, 4),
                        -4.5 + test_scenes::uniform(random, 3e-5, 1e-3));
    by_hand::add(scene, "needle", {at - 0.5 * along, at + 0.5 * along, at + width * across});
  }
  scene = finished(std::move(scene));
  turn(scene, by_hand::random_rotation(random));
  expect_same_bits(scene, 0.5, 0.9);
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
