#include "core/thermal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "scene/scene_input.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel {
namespace {

using test_messages::expect_words;

constexpr std::uint32_t kBoth = kFront | kBack;

InputMaterial heated(const std::string& name, InputHeat heat) {
  InputMaterial material;
  material.name = name;
  material.rho = Rgb(0.125);
  material.Ke = Rgb(1, 2, 3);
  material.heat = heat;
  return material;
}

/// The six faces of a unit cube, normals outward; the first has material 0, the others material 1.
SceneInput cube(InputHeat first, InputHeat others) {
  SceneInput input;
  input.file = "cube.obj";
  input.materials = {heated("first", first), heated("others", others)};
  input.groups = {"first", "others"};
  for (const closed_forms::Polygon& face : closed_forms::box({0, 0, 0}, {1, 1, 1})) {
    const std::uint32_t kind = input.polygons.empty() ? 0 : 1;
    input.polygons.push_back({face, MaterialId{kind}, GroupId{kind}});
  }
  return input;
}

Scene thermal_scene(const SceneInput& input, Sides sides = Sides::one) {
  SceneSettings settings;
  settings.sides = sides;
  settings.thermal = true;
  return build_scene(input, settings);
}

std::string error_of(const SceneInput& input) {
  try {
    require_emitter(thermal_scene(input));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Thermal, AGivenTemperatureIsExitanceAndReflectance) {
  const ThermalSurface surface{0.8, 1000.0, 0};
  EXPECT_NEAR(own_exitance(surface), 0.8 * 56703.74419, 1e-9);
  EXPECT_DOUBLE_EQ(reflectance(surface), 0.2);
  EXPECT_NEAR(black_exitance(surface, 12345), 56703.74419, 1e-9) << "whatever arrives";
  EXPECT_EQ(own_exitance({1, 0.0, 0}), 0);
}

// B = E + rho H, q = B - H and q = eps (sigma T^4 - H) for any H.
TEST(Thermal, AGivenFluxIsTheNetRadiation) {
  for (const double q : {-150.0, 0.0, 300.0}) {
    for (const double H : {500.0, 2000.0}) {
      const ThermalSurface surface{0.25, std::nullopt, q};
      const double B = own_exitance(surface) + reflectance(surface) * H;
      EXPECT_DOUBLE_EQ(B - H, q);
      EXPECT_NEAR(0.25 * (black_exitance(surface, H) - H), q, 1e-12);
    }
  }
}

TEST(Thermal, TemperatureIsTheFourthRoot) {
  EXPECT_NEAR(temperature_of(5.670374419e-8 * 1e12), 1000, 1e-12);
  EXPECT_EQ(temperature_of(0), 0);
  EXPECT_TRUE(std::isnan(temperature_of(-1)));
  const ThermalSurface surface{0.3, 451.0, 0};
  EXPECT_NEAR(temperature_of(black_exitance(surface, 0)), 451, 1e-12);
}

TEST(Thermal, MaterialsTakeTheirHeatForLight) {
  const SceneInput input = cube({0.75, 1000.0, {}}, {{}, {}, -3.0});
  const Scene scene = thermal_scene(input);
  EXPECT_DOUBLE_EQ(scene.materials[0].rho.g, 0.25);
  EXPECT_NEAR(scene.materials[0].E.b, 0.75 * 56703.74419, 1e-9);
  EXPECT_EQ(scene.materials[0].back_exitance(), scene.materials[0].E);
  EXPECT_EQ(scene.materials[1].rho, Rgb(1));
  EXPECT_EQ(scene.materials[1].E, Rgb(-3));
  EXPECT_TRUE(scene.materials[1].emits());
  EXPECT_EQ(scene.materials[1].thermal->emissivity, 1);
}

TEST(Thermal, WithoutThermalHeatHasNoEffect) {
  const Scene scene = build_scene(cube({0.75, 1000.0, {}}, {}), {});
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.125));
  EXPECT_EQ(scene.materials[0].E, Rgb(1, 2, 3));
  EXPECT_EQ(scene.materials[0].back_exitance(), Rgb(0)) << "light is emitted by the front alone";
  EXPECT_FALSE(scene.materials[0].thermal.has_value());
}

TEST(Thermal, AMaterialInUseMustSayEnough) {
  const InputHeat enough{0.75, 1000.0, {}};
  expect_words(error_of(cube(enough, {})),
               {"cube.obj: ", "material 'others' has no temperature and no heat_flux", "[materials.others]"});
  expect_words(error_of(cube(enough, {0.5, {}, {}})), {"'others' has no temperature and no heat_flux"});
  expect_words(error_of(cube(enough, {{}, 300.0, {}})), {"'others' has no emissivity"});
  EXPECT_EQ(error_of(cube(enough, {{}, {}, 0.0})), "no error") << "the emissivity of a flux may be left out";
  SceneInput unused = cube(enough, enough);
  unused.materials.push_back(heated("unused", {}));
  EXPECT_EQ(error_of(unused), "no error");
}

TEST(Thermal, WhatHasNoSolutionIsRefused) {
  expect_words(error_of(cube({{}, {}, 10.0}, {{}, {}, -2.0})), {"no surface has a temperature"});
  expect_words(error_of(cube({1.0, 0.0, {}}, {{}, {}, 0.0})), {"no surface emits heat"});
  const double emitted = 56703.74419;
  expect_words(error_of(cube({1.0, 1000.0, {}}, {{}, {}, -emitted / 4.9})),
               {"the prescribed fluxes draw 57861", "no more than 56703.7 W"});
  EXPECT_EQ(error_of(cube({1.0, 1000.0, {}}, {{}, {}, -emitted / 5.1})), "no error");
}

// What a body's inside sends stays there, but it is sent: which side is meant is not Fluxel's to guess.
TEST(Thermal, InsidesOfWarmBodiesAreNotSealed) {
  const InputHeat warm{0.5, 300.0, {}}, nothing{0.5, 0.0, {}};
  for (const Patch& patch : thermal_scene(cube(warm, nothing), Sides::two).patches)
    EXPECT_EQ(patch.sides, kBoth);
  for (const Patch& patch : thermal_scene(cube({{}, {}, -1.0}, nothing), Sides::two).patches)
    EXPECT_EQ(patch.sides, kBoth) << "what draws heat inside counts too";
  for (const Patch& patch : thermal_scene(cube(nothing, nothing), Sides::two).patches)
    EXPECT_EQ(patch.sides, kFront);
}

}  // namespace
}  // namespace fluxel
