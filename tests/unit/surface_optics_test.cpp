#include "scene/surface_optics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "scene/scene_input.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel {
namespace {

using test_messages::expect_words;

constexpr std::uint32_t kBlackFloor = 0, kGlass = 1, kWater = 2;  // materials

/// A black floor that emits, and what stands over it; materials of clear bodies stand in lines 7 and 9.
struct SceneOfBodies {
  SceneOfBodies() {
    input.file = "dir/scene.toml";
    input.materials = {{"floor", Rgb{0.0}, Rgb{1.0}, {}, {}},
                       {"glass", Rgb{0.0}, Rgb{0.0}, {}, {}},
                       {"water", Rgb{0.0}, Rgb{0.0}, {}, {}}};
    input.materials[kGlass].optics.refraction_index = 1.5;
    input.materials[kGlass].optics_line = 7;
    input.materials[kWater].optics.refraction_index = 1.33;
    input.materials[kWater].optics_line = 9;
    add("floor", kBlackFloor, {{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}});
  }
  void add(const std::string& group, std::uint32_t material,
           const std::vector<closed_forms::Polygon>& faces) {
    for (const closed_forms::Polygon& face : faces)
      input.polygons.push_back(
          {face, MaterialId{material}, GroupId{static_cast<std::uint32_t>(input.groups.size())}});
    input.groups.push_back(group);
  }
  [[nodiscard]] Scene built(Specular specular = Specular::follow, bool thermal = false) const {
    SceneSettings settings;
    settings.specular = specular;
    settings.thermal = thermal;
    return build_scene(input, settings);
  }
  [[nodiscard]] std::string error(Specular specular = Specular::follow, bool thermal = false) const {
    try {
      static_cast<void>(built(specular, thermal));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  SceneInput input;
};

std::vector<closed_forms::Polygon> cube(double low, double high) {
  return closed_forms::box({low, low, low}, {high, high, high});
}

TEST(ClearBodies, ABoxOfGlassIsTakenWithBothSides) {
  SceneOfBodies scene;
  scene.add("block", kGlass, cube(1, 2));
  const Scene built = scene.built();
  EXPECT_EQ(built.statistics.sealed_sides, 0u);
  for (std::size_t i = 1; i < built.patches.size(); ++i) EXPECT_EQ(built.patches[i].sides, kFront | kBack);
  EXPECT_TRUE(built.notes.empty()) << built.notes.front();
}

TEST(ClearBodies, TheyHaveToBeClosed) {
  SceneOfBodies scene;
  std::vector<closed_forms::Polygon> faces = cube(1, 2);
  faces.pop_back();
  scene.add("vase", kGlass, faces);
  expect_words(scene.error(), {"dir/scene.toml:7:", "material 'glass' has a refraction_index",
                               "its surface has an open edge (group 'vase')", "transmission"});
  scene.input.materials[kGlass].optics = {};
  EXPECT_EQ(scene.error(), "no error") << "other surfaces may be open";
}

TEST(ClearBodies, NormalsHaveToAgree) {
  SceneOfBodies scene;
  std::vector<closed_forms::Polygon> faces = cube(1, 2);
  std::ranges::reverse(faces[3]);
  scene.add("block", kGlass, faces);
  expect_words(scene.error(), {":7:", "its surface's normals do not agree (group 'block')"});
}

TEST(ClearBodies, NormalsHaveToPointOutwards) {
  SceneOfBodies scene;
  scene.add("block", kGlass, closed_forms::reversed(cube(1, 2)));
  expect_words(scene.error(), {":7:", "its normals point inwards (group 'block')", "turn its faces around"});
}

TEST(ClearBodies, TheyMayBeHollow) {
  SceneOfBodies scene;
  scene.add("outside", kGlass, cube(1, 2));
  scene.add("inside", kGlass, closed_forms::reversed(cube(1.1, 1.9)));
  EXPECT_EQ(scene.error(), "no error");
}

TEST(ClearBodies, TheyDoNotLieWithinEachOther) {
  for (const std::uint32_t inner : {kGlass, kWater}) {
    SceneOfBodies scene;
    scene.add("outside", kGlass, cube(1, 2));
    scene.add("inside", inner, cube(1.25, 1.75));
    expect_words(scene.error(), {inner == kGlass ? ":7:" : ":9:",
                                 "lies within another clear body (group 'inside')", "there has to be air"});
  }
}

TEST(ClearBodies, TwoOfThemDoNotTouchAlongAnEdge) {
  SceneOfBodies scene;
  std::vector<closed_forms::Polygon> faces = cube(1, 2);
  const closed_forms::Polygon last = faces.back();
  faces.pop_back();
  scene.add("block", kGlass, faces);
  scene.add("window", kWater, {last});
  expect_words(scene.error(), {":9:", "material 'water' has a refraction_index",
                               "touches another clear material along an edge (group 'window')"});
}

TEST(SpecularSurfaces, AreRefusedByMethodsThatDoNotKnowThem) {
  const std::vector<std::pair<SurfaceOptics, std::string>> all = {
      {{.mirror = Rgb(0, 0, 0.1)}, "(mirror)"},
      {{.transmission = Rgb(0.1)}, "(transmission)"},
      {{.diffuse_transmission = Rgb(0.1)}, "(diffuse_transmission)"},
      {{.refraction_index = 1.2}, "(refraction_index)"}};
  for (const auto& [optics, name] : all) {
    SceneOfBodies scene;
    scene.input.materials[kGlass].optics = optics;
    EXPECT_EQ(scene.error(Specular::refuse), "no error") << "no face has it";
    scene.add("block", kGlass, cube(1, 2));
    EXPECT_EQ(scene.error(Specular::follow), "no error");
    expect_words(scene.error(Specular::refuse),
                 {"dir/scene.toml:7:", "material 'glass' does more than reflect evenly " + name,
                  "'fluxel photons'", "--specular absorb"});
  }
}

TEST(SpecularSurfaces, AreBlackButForRhoWhereTheyAbsorb) {
  SceneOfBodies scene;
  scene.add("block", kGlass, cube(1, 2));
  scene.add("pane", kWater, {{{3, 3, 1}, {4, 3, 1}, {4, 4, 1}}});
  scene.input.materials[kWater].optics = {.mirror = Rgb(0.5), .transmission = Rgb(0.25)};
  scene.input.materials[kWater].rho = Rgb(0.25);
  const Scene built = scene.built(Specular::absorb);
  EXPECT_TRUE(built.materials[kGlass].is_diffuse());
  EXPECT_TRUE(built.materials[kWater].is_diffuse());
  EXPECT_EQ(built.materials[kGlass].kept(), Rgb(0));
  EXPECT_EQ(built.materials[kWater].kept(), Rgb(0.25));
  ASSERT_FALSE(built.notes.empty());
  EXPECT_EQ(built.notes[0], "--specular absorb: 2 materials are taken as black but for rho");
  EXPECT_EQ(built.statistics.sealed_sides, 6u) << "no light gets into the block";
  const Scene followed = scene.built(Specular::follow);
  EXPECT_EQ(followed.materials[kWater].kept(), Rgb(1));
  EXPECT_EQ(followed.materials[kGlass].kept(), Rgb(1));
}

TEST(SpecularSurfaces, AreRefusedByThermalRuns) {
  SceneOfBodies scene;
  for (InputMaterial& material : scene.input.materials) material.heat = InputHeat{Emissivity(0.5), 300.0, {}};
  EXPECT_EQ(scene.error(Specular::refuse, true), "no error");
  scene.add("block", kGlass, cube(1, 2));
  for (const Specular specular : {Specular::refuse, Specular::absorb, Specular::follow})
    expect_words(scene.error(specular, true),
                 {"dir/scene.toml:7:", "material 'glass' does more than reflect evenly", "--thermal"});
}

}  // namespace
}  // namespace fluxel
