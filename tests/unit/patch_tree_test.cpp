#include "visibility/patch_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "scene/polygon.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::uniform_point;

constexpr double kEpsilon = 1e-9;

/// Candidates by the tree, in ascending order.
std::vector<PatchId> listed(const PatchTree& tree, const Shaft& shaft) {
  std::vector<PatchId> ids;
  tree.candidates(shaft, kEpsilon, ids);
  std::ranges::sort(ids);
  return ids;
}

/// Candidates by trying every patch, in ascending order.
std::vector<PatchId> tried(const Scene& scene, const Shaft& shaft) {
  std::vector<PatchId> ids;
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    if (shaft.may_meet(scene.patches[i].outline, kEpsilon))
      ids.push_back(PatchId{static_cast<std::uint32_t>(i)});
  }
  return ids;
}

Polygon random_triangle(std::mt19937& random, const Box& box) {
  const auto point = [&] { return box.low + uniform_point(random, 0, 1) * (box.high - box.low); };
  const glm::dvec3 a = point(), b = point();
  return {a, b, point()};
}

bool on_one_side(const Polygon& a, const Polygon& b) {
  const auto above = [&](const glm::dvec3& x) { return glm::dot(area_vector(a), x - a[0]) > 0; };
  return std::ranges::all_of(b, above) || std::ranges::none_of(b, above);
}

Box random_box(std::mt19937& random) {
  const glm::dvec3 low = uniform_point(random, -1, 0.7);
  return {low, low + uniform_point(random, 0.05, 0.3)};
}

/// Adds a cube about the origin whose faces are grids of n x n squares.
void add_gridded_box(Scene& scene, double half, int n, bool outward) {
  Scene box = by_hand::empty_scene(Sides::one);
  by_hand::add_box(box, "box", glm::dvec3(-half), glm::dvec3(half), outward);
  for (const Patch& face : box.patches) {
    const auto& corner = face.outline.corner;
    const glm::dvec3 u = (corner[1] - corner[0]) / double(n), v = (corner[3] - corner[0]) / double(n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const glm::dvec3 at = corner[0] + double(i) * u + double(j) * v;
        by_hand::add(scene, "square", {at, at + u, at + u + v, at + v});
      }
    }
  }
}

PolygonView polygon(const Scene& scene, std::size_t patch) { return corners(scene.patches[patch].outline); }

/// Every pair of patches, coplanar ones and those at an edge included.
template <class Check>
void for_each_pair(const Scene& scene, Check check) {
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) check(Shaft(polygon(scene, i), polygon(scene, j)));
  }
}

TEST(PatchTree, ListsWhatTryingEveryPatchLists) {
  const Scene scene = test_scenes::random_plates(500, 0.2, Sides::two, 1);
  const PatchTree tree(scene);
  std::mt19937 random(2);
  std::size_t candidates = 0;
  for (int k = 0; k < 300; ++k) {
    const Box first = random_box(random), second = random_box(random);
    const Shaft clusters(first, second);
    const std::vector<PatchId> of_clusters = listed(tree, clusters);
    EXPECT_EQ(of_clusters, tried(scene, clusters));

    const Polygon a = random_triangle(random, first), b = random_triangle(random, second);
    if (!on_one_side(a, b) || !on_one_side(b, a)) continue;
    const Shaft pair(a, b);
    const std::vector<PatchId> expected = tried(scene, pair);
    EXPECT_EQ(listed(tree, pair), expected);
    std::vector<PatchId> filtered;
    tree.filter(pair, kEpsilon, of_clusters, filtered);
    EXPECT_EQ(filtered, expected);
    std::vector<PatchId> few;
    EXPECT_TRUE(tree.filter(pair, kEpsilon, of_clusters, few, expected.size()));
    EXPECT_EQ(few, expected);
    few.clear();
    EXPECT_EQ(tree.filter(pair, kEpsilon, of_clusters, few, 2), expected.size() <= 2);
    EXPECT_EQ(few.size(), std::min<std::size_t>(expected.size(), 2));
    few.clear();
    EXPECT_EQ(tree.candidates(pair, kEpsilon, few, 2), expected.size() <= 2);
    EXPECT_EQ(few.size(), std::min<std::size_t>(expected.size(), 2));
    candidates += expected.size();
  }
  EXPECT_GT(candidates, 1000u);
}

TEST(PatchTree, BoxesOfFreePatchesAreMostlyFree) {
  const Scene scene = test_scenes::random_plates(500, 0.1, Sides::two, 6);
  std::mt19937 random(7);
  int free_boxes = 0, free_patches = 0;
  for (int k = 0; k < 50; ++k) {
    const Shaft shaft(random_triangle(random, random_box(random)),
                      random_triangle(random, random_box(random)));
    for (const Patch& patch : scene.patches) {
      const bool meets = shaft.may_meet(patch.outline, kEpsilon);
      const bool box_meets = shaft.may_meet(bounds(corners(patch.outline)), kEpsilon);
      EXPECT_TRUE(box_meets || !meets);
      free_patches += meets ? 0 : 1;
      free_boxes += box_meets ? 0 : 1;
    }
  }
  EXPECT_GT(free_boxes, 0.95 * free_patches);
}

TEST(PatchTree, AppendsAndRepeatsItself) {
  const Scene scene = test_scenes::random_plates(200, 0.3, Sides::two, 3);
  const Shaft shaft(Box{glm::dvec3(-1), glm::dvec3(-0.5)}, Box{glm::dvec3(0.5), glm::dvec3(1)});
  std::vector<PatchId> once, twice{kNoPatch};
  PatchTree(scene).candidates(shaft, kEpsilon, once);
  PatchTree(scene).candidates(shaft, kEpsilon, twice);
  EXPECT_FALSE(once.empty());
  once.insert(once.begin(), kNoPatch);
  EXPECT_EQ(once, twice);
}

TEST(PatchTree, ConvexRoomHasNoCandidates) {
  std::mt19937 random(4);
  Scene scene = by_hand::empty_scene(Sides::one);
  add_gridded_box(scene, 1.5, 5, false);
  for (int turn = 0; turn < 4; ++turn) {
    const PatchTree tree(scene);
    int occluded = 0;
    const auto check = [&](const Shaft& shaft) {
      occluded += listed(tree, shaft).empty() && tried(scene, shaft).empty() ? 0 : 1;
    };
    for_each_pair(scene, check);
    // Triangles on the walls and across the room, each other's planes cut or not.
    const auto corner = [&] { return scene.patches[random() % scene.patches.size()].outline.corner[0]; };
    for (int k = 0; k < 300; ++k) check(Shaft(Polygon{corner(), corner(), corner()}, polygon(scene, 0)));
    EXPECT_EQ(occluded, 0);
    by_hand::rotate(scene, by_hand::random_rotation(random));
  }
}

TEST(PatchTree, BodyInARoomStandsBetweenItsSquares) {
  std::mt19937 random(5);
  Scene scene = by_hand::empty_scene(Sides::one);
  add_gridded_box(scene, 1.5, 3, false);
  add_gridded_box(scene, 0.5, 2, true);
  std::vector<std::size_t> counts;
  for (int turn = 0; turn < 3; ++turn) {
    const PatchTree tree(scene);
    std::size_t free_pairs = 0;
    for_each_pair(scene, [&](const Shaft& shaft) {
      const std::vector<PatchId> ids = listed(tree, shaft);
      EXPECT_EQ(ids, tried(scene, shaft));
      free_pairs += ids.empty() ? 1 : 0;
    });
    counts.push_back(free_pairs);
    by_hand::rotate(scene, by_hand::random_rotation(random));
  }
  EXPECT_GT(counts[0], 0u);
  EXPECT_EQ(counts[1], counts[0]);
  EXPECT_EQ(counts[2], counts[0]);
}

TEST(PatchTree, HoldsManyPatchesInOnePlaceAndNone) {
  Scene scene = by_hand::empty_scene(Sides::one);
  const Shaft shaft(Box{glm::dvec3(-1), glm::dvec3(-0.5)}, Box{glm::dvec3(0.5), glm::dvec3(1)});
  EXPECT_TRUE(listed(PatchTree(scene), shaft).empty());
  for (int k = 0; k < 100; ++k) by_hand::add(scene, "same", {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0.1}});
  EXPECT_EQ(listed(PatchTree(scene), shaft).size(), 100u);
}

}  // namespace
}  // namespace fluxel
