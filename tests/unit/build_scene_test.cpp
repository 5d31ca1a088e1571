#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.hpp"
#include "scene/polygon.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {
namespace {

/// A cube of 2 m far from the world's origin, its faces inward, with a lamp in its ceiling and a wall across.
SceneInput room() {
  SceneInput input;
  input.materials = {{"white", Rgb{0.5}, Rgb{0.0}, {}, {}}, {"lamp", Rgb{0.0}, Rgb{3.0}, {}, {}}};
  input.groups = {"shell", "lamp", "wall"};
  const auto add = [&](std::vector<glm::dvec3> corner, std::uint32_t kind) {
    for (glm::dvec3& x : corner) x += glm::dvec3{1000, 0, 0};
    input.polygons.push_back({corner, MaterialId{kind == 1 ? 1u : 0u}, GroupId{kind}});
  };
  add({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, 0);
  add({{0, 0, 2}, {0, 2, 2}, {2, 2, 2}, {2, 0, 2}}, 0);
  add({{0, 0, 0}, {0, 0, 2}, {2, 0, 2}, {2, 0, 0}}, 0);
  add({{0, 2, 0}, {2, 2, 0}, {2, 2, 2}, {0, 2, 2}}, 0);
  add({{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}}, 0);
  add({{2, 0, 0}, {2, 0, 2}, {2, 2, 2}, {2, 2, 0}}, 0);
  add({{0.25, 0.25, 2}, {0.25, 0.75, 2}, {0.75, 0.75, 2}, {0.75, 0.25, 2}}, 1);
  add({{1, 0, 0}, {1, 2, 0}, {1, 2, 2}, {1, 0, 2}}, 2);
  return input;
}

TEST(BuildScene, FillsPiecesAndFacts) {
  const Scene scene = build_scene(room(), {});
  EXPECT_EQ(scene.patches.size(), 8u);
  EXPECT_EQ(scene.facts.components, 3u);
  EXPECT_EQ(scene.facts.closed_components, 1u);
  EXPECT_FALSE(scene.facts.closed);
  EXPECT_EQ(scene.facts.boundary_edges, 8u);
  EXPECT_EQ(scene.facts.coplanar_overlaps, 1u);
  EXPECT_DOUBLE_EQ(scene.facts.covered_area, 0.25);
  EXPECT_EQ(scene.facts.cut_patches, 4u);  // floor, ceiling and two walls, by the wall
  EXPECT_EQ(scene.facts.sealed_sides, 0u);
  double sum = 0;
  for (const Piece& piece : scene.pieces) sum += area(corners(piece.outline));
  EXPECT_DOUBLE_EQ(sum, 24 + 4);
  EXPECT_NO_THROW(require_emitter(scene));
}

TEST(BuildScene, ARoomWithoutLightIsSealed) {
  SceneInput input = room();
  input.materials[1].Ke = Rgb{0.0};
  const Scene scene = build_scene(input, {});
  EXPECT_EQ(scene.facts.sealed_sides, 6u);
  EXPECT_THROW(require_emitter(scene), InputError);
  SceneSettings with_camera;
  with_camera.camera_eye = glm::dvec3{1000.5, 1, 1};
  EXPECT_EQ(build_scene(input, with_camera).facts.sealed_sides, 0u);
}

TEST(BuildScene, PiecesOfAPatchAreContiguous) {
  const Scene scene = build_scene(room(), {});
  std::vector<PatchId> runs;
  for (const Piece& piece : scene.pieces) {
    if (runs.empty() || runs.back() != piece.patch) runs.push_back(piece.patch);
  }
  std::sort(runs.begin(), runs.end());
  EXPECT_EQ(std::adjacent_find(runs.begin(), runs.end()), runs.end());
  EXPECT_EQ(runs.size(), 8u);
}

}  // namespace
}  // namespace fluxel
