#include "scene/patch_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene_by_hand.hpp"

namespace fluxel {
namespace {

using namespace by_hand;

std::size_t patches_held(const PatchMesh& mesh) {
  std::size_t sum = 0;
  for (const PatchComponent& component : mesh.components) sum += component.patches.size();
  return sum;
}

TEST(PatchMesh, CubeIsClosedAndOriented) {
  Scene scene = empty_scene(Sides::two);
  add_box(scene, "cube", {0, 0, 0}, {1, 1, 1}, true);
  const PatchMesh mesh = connect_patches(scene);
  ASSERT_EQ(mesh.components.size(), 1u);
  EXPECT_TRUE(mesh.components[0].closed);
  EXPECT_TRUE(mesh.components[0].oriented);
  EXPECT_EQ(mesh.components[0].patches.size(), 6u);
  EXPECT_EQ(mesh.boundary_edges + mesh.nonmanifold_edges + mesh.flipped_edges, 0u);
}

TEST(PatchMesh, CornersWithinTheToleranceAreOne) {
  Scene scene = empty_scene(Sides::two);
  add_box(scene, "cube", {0, 0, 0}, {1, 1, 1}, true);
  for (Patch& patch : scene.patches) {
    for (glm::dvec3& x : patch.outline.corner) x += 4e-7 * patch.normal;
  }
  EXPECT_TRUE(connect_patches(scene).components[0].closed);
  for (Patch& patch : scene.patches) {
    for (glm::dvec3& x : patch.outline.corner) x += 4e-6 * patch.normal;
  }
  EXPECT_EQ(connect_patches(scene).components.size(), 6u);
}

TEST(PatchMesh, FlippedFaceLeavesItClosed) {
  Scene scene = empty_scene(Sides::two);
  add_box(scene, "cube", {0, 0, 0}, {1, 1, 1}, true);
  auto& outline = scene.patches[3].outline;
  std::reverse(outline.corner.begin(), outline.corner.end());
  const PatchMesh mesh = connect_patches(scene);
  ASSERT_EQ(mesh.components.size(), 1u);
  EXPECT_TRUE(mesh.components[0].closed);
  EXPECT_FALSE(mesh.components[0].oriented);
  EXPECT_EQ(mesh.flipped_edges, 4u);
  EXPECT_EQ(mesh.boundary_edges, 0u);
}

TEST(PatchMesh, ThreeFacesAtAnEdgeLoseNothing) {
  Scene scene = empty_scene(Sides::two);
  add(scene, "a", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add(scene, "b", {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  add(scene, "c", {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {0, -1, 0}});
  const PatchMesh mesh = connect_patches(scene);
  EXPECT_EQ(patches_held(mesh), 3u);
  EXPECT_EQ(mesh.components.size(), 1u);
  EXPECT_EQ(mesh.nonmanifold_edges, 1u);
  EXPECT_EQ(mesh.boundary_edges, 9u);
  EXPECT_FALSE(mesh.components[0].closed);
  EXPECT_FALSE(mesh.components[0].oriented);
}

TEST(PatchMesh, BowTieAtAVertexIsTwoComponents) {
  Scene scene = empty_scene(Sides::two);
  add(scene, "a", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  add(scene, "b", {{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}});
  add_box(scene, "cube", {5, 5, 5}, {6, 6, 6}, true);
  const PatchMesh mesh = connect_patches(scene);
  ASSERT_EQ(mesh.components.size(), 3u);
  EXPECT_EQ(mesh.boundary_edges, 6u);
  EXPECT_EQ(mesh.component[1], 1u);
  EXPECT_EQ(mesh.component[7], 2u);
  EXPECT_TRUE(mesh.components[2].closed);
  EXPECT_FALSE(mesh.components[1].closed);
}

TEST(PatchMesh, CubesThatShareAnEdgeAreOneClosedComponent) {
  Scene scene = empty_scene(Sides::two);
  add_box(scene, "one", {0, 0, 0}, {1, 1, 1}, true);
  add_box(scene, "two", {1, 1, 0}, {2, 2, 1}, true);
  const PatchMesh mesh = connect_patches(scene);
  ASSERT_EQ(mesh.components.size(), 1u);
  EXPECT_EQ(mesh.nonmanifold_edges, 1u);
  EXPECT_TRUE(mesh.components[0].closed);
  EXPECT_FALSE(mesh.components[0].oriented);
}

TEST(PatchMesh, LongEdgeAgainstTwoShortOnesIsBoundary) {
  Scene scene = empty_scene(Sides::two);
  add(scene, "long", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  add(scene, "short", {{0, 0, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0}});
  add(scene, "short", {{1, 0, 0}, {1, -1, 0}, {2, -1, 0}, {2, 0, 0}});
  const PatchMesh mesh = connect_patches(scene);
  EXPECT_EQ(mesh.components.size(), 2u);
  EXPECT_EQ(mesh.boundary_edges, 10u);
}

}  // namespace
}  // namespace fluxel
