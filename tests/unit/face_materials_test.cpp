#include "scene/face_materials.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "scene/to_patches.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::face_materials_test {
namespace {

using test_messages::expect_words;

constexpr double kRounding = 1e-12;

/// Rectangles side by side of the given widths and reflectances, of material 0, `wood`, with a texture.
SceneInput strips(const std::vector<double>& widths, const std::vector<Rgb>& rho) {
  SceneInput input;
  input.groups = {"floor"};
  InputMaterial wood, paint;
  wood.name = "wood";
  wood.textured = true;
  paint.name = "paint";
  input.materials = {wood, paint};
  double x = 0;
  for (std::size_t k = 0; k < widths.size(); ++k) {
    const double next = x + widths[k];
    input.polygons.push_back({{{x, 0, 0}, {next, 0, 0}, {next, 1, 0}, {x, 1, 0}}, MaterialId{0}, GroupId{0}});
    x = next;
  }
  input.face_rho = rho;
  set_mean_reflectance(input);
  return input;
}

Scene make(const SceneInput& input, Textures textures, bool thermal = false) {
  SceneSettings settings;
  settings.textures = textures;
  settings.thermal = thermal;
  return to_patches(input, settings);
}

Rgb reflected(const Scene& scene) {
  Rgb sum{0};
  for (const Patch& patch : scene.patches) sum += patch.area * scene.material(patch).rho;
  return sum;
}

TEST(FaceMaterials, MaterialsHaveTheMeanByArea) {
  const SceneInput input = strips({1, 3}, {Rgb(1, 0.4, 0), Rgb(0.2, 0.4, 0)});
  EXPECT_NEAR(input.materials[0].rho.r, 0.4, kRounding);
  EXPECT_NEAR(input.materials[0].rho.g, 0.4, kRounding);
  EXPECT_EQ(input.materials[1].rho, Rgb(0.5));
  const Scene scene = make(input, Textures::mean);
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(FaceMaterials, WithoutAreaTheReflectanceStays) {
  SceneInput input = strips({0}, {Rgb(1)});
  EXPECT_EQ(input.materials[0].rho, Rgb(0.5));
}

TEST(FaceMaterials, LargeFacesGetTheirOwn) {
  const SceneInput input = strips({1, 1, 1, 1, 1}, {Rgb(0.5), Rgb(0.1), Rgb(0.9), Rgb(0.104), Rgb(0.495)});
  const Scene scene = make(input, Textures::face);
  // The mean is 0.42: all faces differ. 0.5 and 0.495 are 4 steps away, 0.1 and 0.104 are 16, 0.9 is 24.
  ASSERT_EQ(scene.materials.size(), 5u);
  EXPECT_EQ(scene.materials[2].name, "wood (face 1)");
  EXPECT_EQ(scene.materials[3].name, "wood (face 2)");
  EXPECT_EQ(scene.materials[4].name, "wood (face 3)");
  EXPECT_NEAR(scene.materials[2].rho.r, 0.4975, kRounding);
  EXPECT_NEAR(scene.materials[3].rho.r, 0.102, kRounding);
  EXPECT_NEAR(scene.materials[4].rho.r, 0.9, kRounding);
  ASSERT_EQ(scene.patches.size(), 5u);
  EXPECT_EQ(scene.patches[3].material, scene.patches[1].material);
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"5 large faces differ", "0.01", "3 materials of their own"});
  EXPECT_NEAR(reflected(scene).r, reflected(make(input, Textures::mean)).r, kRounding);
}

TEST(FaceMaterials, AChannelAloneDiffers) {
  const Scene scene = make(strips({1, 1}, {Rgb(0.5, 0.5, 0.4), Rgb(0.5, 0.5, 0.6)}), Textures::face);
  EXPECT_EQ(scene.materials.size(), 4u);
  EXPECT_EQ(scene.material(scene.patches[1]).rho, Rgb(0.5, 0.5, 0.6));
}

TEST(FaceMaterials, SmallAndLikeFacesKeepTheirMaterial) {
  // Of 10 m2, 0.0005 m2 is less than 1e-4; 0.5 is less than 0.01 from the mean.
  const SceneInput input = strips({9, 0.0005, 1}, {Rgb(0.5), Rgb(0), Rgb(0.505)});
  const Scene scene = make(input, Textures::face);
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_TRUE(scene.notes.empty());
  EXPECT_NEAR(reflected(scene).r, 9 * 0.5 + 0.505, kRounding);
}

TEST(FaceMaterials, WhatIsLeftHasItsOwnMean) {
  const SceneInput input = strips({9, 1}, {Rgb(0.5), Rgb(0.45)});  // mean 0.495
  const Scene scene = make(input, Textures::face);
  EXPECT_EQ(scene.materials.size(), 3u);
  EXPECT_NEAR(scene.materials[0].rho.r, 0.5, kRounding);
  EXPECT_NEAR(scene.materials[2].rho.r, 0.45, kRounding);
}

TEST(FaceMaterials, OthersAreNotSplit) {
  SceneInput input = strips({1, 1}, {Rgb(0), Rgb(1)});
  set_reflectance(MaterialId{0}, Rgb(0.3), input);
  EXPECT_EQ(make(input, Textures::face).materials.size(), 2u);
  EXPECT_EQ(make(input, Textures::face).materials[0].rho, Rgb(0.3));
  input = strips({1, 1}, {Rgb(0), Rgb(1)});
  for (InputMaterial& material : input.materials) material.heat = {0.8, 300.0, {}};
  EXPECT_EQ(make(input, Textures::face, true).materials.size(), 2u);
  SceneInput plain = strips({1, 1}, {});
  EXPECT_EQ(make(plain, Textures::face).materials.size(), 2u);
}

TEST(FaceMaterials, OwnMaterialsEmitAsTheirs) {
  SceneInput input = strips({1, 1}, {Rgb(0), Rgb(1)});
  input.materials[0].E = Rgb(3);
  const Scene scene = make(input, Textures::face);
  for (const Patch& patch : scene.patches) EXPECT_EQ(scene.material(patch).E, Rgb(3));
}

}  // namespace
}  // namespace fluxel::face_materials_test
