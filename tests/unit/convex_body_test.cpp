#include "visibility/convex_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// Each parallelogram cut along its first diagonal.
void cut_into_triangles(Scene& scene) {
  std::vector<Patch> triangles;
  for (const Patch& patch : scene.patches) {
    const auto& c = patch.outline.corner;
    for (std::uint32_t k = 2; k < patch.outline.corners; ++k) {
      Patch& triangle = triangles.emplace_back(patch);
      triangle.outline = {{c[0], c[k - 1], c[k]}, 3};
      triangle.area = patch.area / (patch.outline.corners - 2);
    }
  }
  scene.patches = std::move(triangles);
}

Scene box(bool triangles) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "box", {-1, -0.5, 0.25}, {0.5, 1, 0.75}, true);
  scene.extent = 1;
  if (triangles) cut_into_triangles(scene);
  return scene;
}

void expect_box(const Scene& scene) {
  const BodyTree tree(scene);
  ASSERT_EQ(tree.bodies().size(), 1u);
  const ConvexBody& body = tree.bodies().front();
  EXPECT_EQ(body.faces, 6u);
  EXPECT_EQ(body.planes, 6u);
  EXPECT_EQ(body.edges, 12u);
  EXPECT_EQ(body.corners, 8u);
  for (std::uint32_t face = 0; face < 6; ++face) {
    EXPECT_EQ(std::popcount(body.left[face]) + std::popcount(body.right[face]), 4);
    EXPECT_EQ(body.left[face] & body.right[face], 0u);
  }
}

TEST(ConvexBodies, ABoxIsOne) {
  std::mt19937 random(31);
  for (const bool triangles : {false, true}) {
    Scene scene = box(triangles);
    expect_box(scene);
    by_hand::rotate(scene, by_hand::random_rotation(random));
    expect_box(scene);
  }
}

TEST(ConvexBodies, WhatIsOpenInwardOrBentIsPolygons) {
  Scene open = box(false);
  open.patches.pop_back();
  EXPECT_EQ(BodyTree(open).bodies().size(), 5u);

  Scene room = by_hand::empty_scene(Sides::one);
  by_hand::add_box(room, "room", glm::dvec3(-1), glm::dvec3(1), false);
  room.extent = 1;
  EXPECT_EQ(BodyTree(room).bodies().size(), 6u);

  // A corner moved by little: faces are planes no more.
  for (const double by : {1e-12, 1e-6, 0.1}) {
    Scene bent = box(true);
    const glm::dvec3 moved = bent.patches[0].outline.corner[0];
    for (Patch& patch : bent.patches)
      for (glm::dvec3& corner : patch.outline.corner)
        if (corner == moved) corner += by * glm::dvec3(-1, 2, 3);
    const BodyTree tree(bent);
    EXPECT_GT(tree.bodies().size(), 6u);
    EXPECT_TRUE(std::ranges::all_of(tree.bodies(), &ConvexBody::is_flat));
  }
}

TEST(ConvexBodies, PolygonsOfAPlaneAreJoined) {
  Scene grid = by_hand::empty_scene(Sides::one);
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 3; ++y)
      by_hand::add(grid, "square", {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
  grid.extent = 4;
  cut_into_triangles(grid);
  const BodyTree tree(grid);
  std::size_t corners = 0;
  for (const ConvexBody& body : tree.bodies()) {
    EXPECT_TRUE(body.is_flat());
    EXPECT_EQ(body.edges, body.corners);
    corners += body.corners;
  }
  EXPECT_LE(tree.bodies().size(), 3u);
  EXPECT_LE(corners, 4 * tree.bodies().size());

  // Facing the other way, or only touching: what joins them is no whole edge that both run along.
  Scene apart = by_hand::empty_scene(Sides::one);
  by_hand::add(apart, "up", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(apart, "down", {{1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}});
  by_hand::add(apart, "half", {{0, 1, 0}, {0.5, 1, 0}, {0.5, 2, 0}, {0, 2, 0}});
  apart.extent = 2;
  EXPECT_EQ(BodyTree(apart).bodies().size(), 3u);
}

}  // namespace
}  // namespace fluxel
