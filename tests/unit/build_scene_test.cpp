#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.hpp"
#include "scene/polygon.hpp"
#include "scene/scene_input.hpp"
#include "tests/unit/messages.hpp"

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

TEST(BuildScene, FillsPiecesAndTotals) {
  const Scene scene = build_scene(room(), {});
  EXPECT_EQ(scene.patches.size(), 8u);
  EXPECT_EQ(scene.statistics.components, 3u);
  EXPECT_EQ(scene.statistics.closed_components, 1u);
  EXPECT_TRUE(scene.statistics.closed);  // the wall stands in the shell, the lamp lies on it
  EXPECT_EQ(scene.statistics.boundary_edges, 8u);
  EXPECT_EQ(scene.statistics.coplanar_overlaps, 1u);
  EXPECT_DOUBLE_EQ(scene.statistics.covered_area, 0.25);
  EXPECT_EQ(scene.statistics.cut_patches, 4u);  // floor, ceiling and two walls, by the wall
  EXPECT_EQ(scene.statistics.sealed_sides, 0u);
  double sum = 0;
  for (const Piece& piece : scene.pieces) sum += area(corners(piece.outline));
  EXPECT_DOUBLE_EQ(sum, 24 + 4);
  EXPECT_NO_THROW(require_emitter(scene));
}

TEST(BuildScene, ALampTooSmallForTheSceneIsTheReasonForNoLight) {
  SceneInput input = room();
  for (InputPolygon& polygon : input.polygons) {
    if (index(polygon.group) != 0) continue;
    for (glm::dvec3& x : polygon.corners) x = 1e8 * (x - glm::dvec3{1000, 0, 0});
  }
  const Scene scene = build_scene(input, {});
  try {
    require_emitter(scene);
    FAIL() << "a lamp of 0.25 m2 in a room of 2e8 m";
  } catch (const InputError& error) {
    test_messages::expect_words(error.what(), {"no patch emits light: ", "'lamp' (1, emitting), 'wall' (1)",
                                               "'shell' reaches farthest", "metres_per_unit"});
  }
}

TEST(BuildScene, AClosedRoomHasToAbsorbLight) {
  SceneInput input = room();
  for (InputMaterial& material : input.materials) material.rho = Rgb(1);
  try {
    require_emitter(build_scene(input, {}));
    FAIL() << "light grows without end";
  } catch (const InputError& error) {
    test_messages::expect_words(error.what(), {"nothing absorbs light", "closed", "a Kd below 1"});
  }
  input.materials[0].rho.g = 0.999;
  EXPECT_THROW(require_emitter(build_scene(input, {})), InputError) << "red and blue still grow";
  input.materials[0].rho = Rgb(0.999);
  EXPECT_NO_THROW(require_emitter(build_scene(input, {})));
  input.materials[0].rho = Rgb(1);
  input.polygons.erase(input.polygons.begin());
  EXPECT_NO_THROW(require_emitter(build_scene(input, {}))) << "it has no floor";
}

TEST(BuildScene, ARoomWithoutLightIsSealed) {
  SceneInput input = room();
  input.materials[1].Ke = Rgb{0.0};
  const Scene scene = build_scene(input, {});
  EXPECT_EQ(scene.statistics.sealed_sides, 6u);
  EXPECT_THROW(require_emitter(scene), InputError);
  SceneSettings with_camera;
  with_camera.camera_eye = glm::dvec3{1000.5, 1, 1};
  EXPECT_EQ(build_scene(input, with_camera).statistics.sealed_sides, 0u);
}

/// Makes each quad of the input 2 x 2 quads, of two triangles each.
void tessellate(SceneInput& input) {
  std::vector<InputPolygon> triangles;
  for (const InputPolygon& quad : input.polygons) {
    const glm::dvec3 &a = quad.corners[0], &b = quad.corners[1], &c = quad.corners[2], &d = quad.corners[3];
    const glm::dvec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), cd = 0.5 * (c + d), da = 0.5 * (d + a),
                     m = 0.5 * (ab + cd);
    for (const auto& cell : {std::array{a, ab, m, da}, {ab, b, bc, m}, {m, bc, c, cd}, {da, m, cd, d}}) {
      triangles.push_back({{cell[0], cell[1], cell[2]}, quad.material, quad.group});
      triangles.push_back({{cell[0], cell[2], cell[3]}, quad.material, quad.group});
    }
  }
  input.polygons = std::move(triangles);
}

TEST(BuildScene, MergedWallsOverlapAndTouchAsWholeOnesDo) {
  SceneInput input = room();
  const Scene whole = build_scene(input, {});
  tessellate(input);
  const Scene merged = build_scene(input, {});
  ASSERT_EQ(merged.patches.size(), whole.patches.size());
  EXPECT_EQ(merged.statistics.merged_patches, 8u * 8 - 8);
  EXPECT_EQ(merged.statistics.coplanar_overlaps, 1u);
  EXPECT_EQ(merged.statistics.cut_patches, whole.statistics.cut_patches);
  EXPECT_EQ(merged.statistics.closed_components, whole.statistics.closed_components);
  ASSERT_EQ(merged.pieces.size(), whole.pieces.size());
  for (std::size_t i = 0; i < whole.pieces.size(); ++i) {
    EXPECT_EQ(merged.pieces[i].patch, whole.pieces[i].patch);
    EXPECT_TRUE(merged.pieces[i].outline.corner == whole.pieces[i].outline.corner);
  }
}

TEST(BuildScene, AClosedBodyStaysClosedWhereMergedWallsMeetOthers) {
  SceneInput input = room();
  input.materials[1].Ke = Rgb{0.0};
  input.polygons.resize(6);
  tessellate(input);
  // The triangles of one wall stay alone: its edges meet those of merged walls in T-junctions.
  for (std::uint32_t i = 0; i < 8; ++i) {
    input.groups.emplace_back("tile");
    input.polygons[i].group = GroupId{static_cast<std::uint32_t>(input.groups.size() - 1)};
  }
  const Scene scene = build_scene(input, {});
  EXPECT_EQ(scene.patches.size(), 8u + 5);
  EXPECT_EQ(scene.statistics.closed_components, 1u);
  EXPECT_TRUE(scene.statistics.closed);
  EXPECT_EQ(scene.statistics.boundary_edges, 0u);
  EXPECT_EQ(scene.statistics.sealed_sides, 8u + 5);
  for (const Patch& patch : scene.patches) EXPECT_EQ(patch.sides, kBack);
}

TEST(BuildScene, WithoutCutsNothingIsMerged) {
  SceneInput input = room();
  tessellate(input);
  SceneSettings settings;
  settings.cut = false;
  EXPECT_EQ(build_scene(input, settings).patches.size(), 64u);
  settings = {};
  settings.merge = false;
  EXPECT_EQ(build_scene(input, settings).patches.size(), 64u);
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
