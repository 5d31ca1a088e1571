#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "tests/unit/test_scenes.hpp"
#include "visibility/cuda/host_trace.hpp"
#include "visibility/device_scene.hpp"
#include "visibility/segment_test.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {
namespace {

using test_scenes::finished;
using test_scenes::random_plates;
using test_scenes::uniform_elements;

/// Shortcuts must not change a bit, on scenes where they are at their limits, nor must the code for GPUs.
struct Comparison {
  std::size_t facing = 0, rays = 0, visible = 0, different = 0, different_for_gpu = 0;
  std::size_t at_ends = 0;  // different for GPUs, as a patch's plane passes through a ray's end
};

std::size_t different_bits(const TileBits& a, const TileBits& b) {
  std::size_t count = 0;
  for (std::size_t r = 0; r < kTileSize; ++r) count += static_cast<std::size_t>(std::popcount(a[r] ^ b[r]));
  return count;
}

/// Whether a patch meets the segment so that Embree, which looks between its ends in single precision, may
/// pass it by: with one of its ends near the patch's plane, or along the plane.
bool is_met_at_an_end(const Scene& scene, const glm::dvec3& from, const glm::dvec3& to, double lift) {
  return std::ranges::any_of(scene.patches, [&](const Patch& patch) {
    const auto height = [&](const glm::dvec3& x) {
      return std::abs(glm::dot(patch.normal, x - patch.outline.corner[0]));
    };
    return segment_meets(patch, from, to) && (std::min(height(from), height(to)) < lift ||
                                              height(from) + height(to) < 1e-4 * glm::length(to - from));
  });
}

/// The pairs of a tile that rays see and GPUs do not, because of what is at a ray's end.
std::size_t met_at_ends(const Scene& scene, const std::vector<Element>& elements, float lift,
                        const cuda::TilePlace& place, const TileBits& traced, const TileBits& on_gpu) {
  std::size_t count = 0;
  for (std::size_t r = 0; r < kTileSize; ++r) {
    for (std::uint64_t left = traced[r] & ~on_gpu[r]; left != 0; left &= left - 1) {
      std::size_t i = place.row * kTileSize + r;
      std::size_t j = place.column * kTileSize + static_cast<std::size_t>(std::countr_zero(left));
      if (j < i) std::swap(i, j);
      const Element &a = elements[i], &b = elements[j];
      const auto lifted_towards = [lift](const Element& element, const Element& other) {
        const bool front = glm::dot(element.normal, other.centroid - element.centroid) > 0;
        return front ? element.centroid + lift * element.normal : element.centroid - lift * element.normal;
      };
      const glm::vec3 from = lifted_towards(a, b), along = lifted_towards(b, a) - from;
      count += is_met_at_an_end(scene, from, glm::dvec3(from) + glm::dvec3(along),
                                std::max(static_cast<double>(lift), 16 * 0x1p-24 * scene.extent))
                   ? 1
                   : 0;
    }
  }
  return count;
}

Comparison compare(const Scene& scene, const std::vector<Element>& elements) {
  const RayScene ray_scene(scene, 1);
  const TileTracer quick(ray_scene, elements), slow(ray_scene, elements, Shortcuts::off);
  const cuda::SceneArrays for_gpu = device_scene(ray_scene, elements);
  Comparison result;
  for (std::size_t row = 0; row < tile_count(elements.size()); ++row) {
    for (std::size_t column = row; column < tile_count(elements.size()); ++column) {
      const TracedTile a = quick.trace(row, column), b = slow.trace(row, column);
      const cuda::TilePlace place{static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column)};
      const TracedTile c = traced_tile(cuda::trace_on_host(for_gpu.view(), place), place, elements.size());
      EXPECT_EQ(a.tag, b.tag);
      EXPECT_EQ(a.tag == TileTag::facing_away, c.tag == TileTag::facing_away);
      result.facing += b.rays;
      result.rays += a.rays;
      result.visible += different_bits(b.bits, TileBits{});
      result.different += different_bits(a.bits, b.bits);
      const std::size_t at_ends =
          met_at_ends(scene, elements, ray_scene.surface_epsilon(), place, b.bits, c.bits);
      result.at_ends += at_ends;
      result.different_for_gpu += different_bits(c.bits, b.bits) - at_ends;
    }
  }
  return result;
}

void add(Comparison& sum, const Comparison& one) {
  sum.facing += one.facing;
  sum.rays += one.rays;
  sum.visible += one.visible;
  sum.different += one.different;
  sum.different_for_gpu += one.different_for_gpu;
  sum.at_ends += one.at_ends;
}

/// Where the ends of rays lie in the planes of patches.
constexpr double kMaxAtEnds = 1e-4;

/// `most_rays`: of the pairs that face each other, so that a test whose pairs are all traced can't pass.
void expect_same(const Comparison& result, double most_rays, double most_at_ends = 0) {
  EXPECT_EQ(result.different, 0u) << "of " << result.facing;
  EXPECT_EQ(result.different_for_gpu, 0u) << "of " << result.facing;
  EXPECT_LE(static_cast<double>(result.at_ends), most_at_ends * static_cast<double>(result.facing));
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

/// Cuts every parallelogram along its first diagonal.
Scene of_triangles(const Scene& scene) {
  Scene result = by_hand::empty_scene(Sides::one);
  for (const Patch& patch : scene.patches) {
    const auto& c = patch.outline.corner;
    by_hand::add(result, "triangle", {c[0], c[1], c[2]});
    by_hand::add(result, "triangle", {c[0], c[2], c[3]});
  }
  return result;
}

// Faces of two triangles are one polygon, and boxes one body, with elements on them, beside them and, of one
// that is open, within.
TEST(Shortcuts, BodiesOfTriangles) {
  std::mt19937 random(14);
  for (const bool aligned : {true, false}) {
    Scene scene = by_hand::empty_scene(Sides::one);
    add_room(scene, {4, 3, 2});
    for (int k = 0; k < 24; ++k) {
      const glm::dvec3 low(test_scenes::uniform(random, -1.9, 1.5), test_scenes::uniform(random, -1.4, 1),
                           test_scenes::uniform(random, -1, 0.5));
      by_hand::add_box(scene, "box", low, low + test_scenes::uniform_point(random, 0.1, 0.4), k % 6 != 0);
      if (k % 6 == 1) scene.patches.pop_back();
    }
    Scene triangles = finished(of_triangles(scene));
    expect_same_bits(triangles, 0.15, 0.5);
    if (aligned) continue;
    turn(triangles, by_hand::random_rotation(random));
    expect_same_bits(triangles, 0.2, 0.5);
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
  expect_same(sum, 0.9, kMaxAtEnds);
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
    scene = finished(std::move(scene));
    expect_same(compare(scene, uniform_elements(scene, 0.2e-4).elements), 0.95, kMaxAtEnds);
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

Scene slivers(int count) {
  std::mt19937 random(7);
  Scene scene = by_hand::empty_scene(Sides::two);
  for (int k = 0; k < count; ++k) {
    const glm::dvec3 at = test_scenes::uniform_point(random, -1, 1);
    const glm::dvec3 along = test_scenes::random_direction(random);
    const double width = std::pow(10.0, -1 - 3 * test_scenes::uniform(random, 0, 1));
    const glm::dvec3 across =
        width * glm::normalize(glm::cross(along, test_scenes::random_direction(random)));
    by_hand::add(scene, "sliver", {at, at + along, at + 0.3 * along + across});
  }
  return finished(std::move(scene));
}

// Eight and sixteen elements each; the first are boxed together, so that nearly all of their pairs are
// traced.
TEST(Shortcuts, Slivers) {
  expect_same_bits(slivers(150), 0.3, 0.97);
  expect_same_bits(slivers(75), 0.15, 0.9);
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
