#include "core/thermal.hpp"
#include "core/options.hpp"

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
  EXPECT_EQ(linearised(surface, 12345).E, own_exitance(surface));
  EXPECT_DOUBLE_EQ(linearised(surface, 12345).rho, 0.2);
  EXPECT_NEAR(black_exitance(surface, 12345), 56703.74419, 1e-9) << "whatever arrives";
  EXPECT_EQ(own_exitance({1, 0.0, 0}), 0);
}

// B = E + rho H, q = B - H and q = eps (sigma T^4 - H) for any H.
TEST(Thermal, AGivenFluxIsTheNetRadiation) {
  for (const double q : {-150.0, 0.0, 300.0}) {
    for (const double H : {500.0, 2000.0}) {
      const ThermalSurface surface{0.25, std::nullopt, q};
      const ThermalExchange exchange = linearised(surface, H);
      EXPECT_DOUBLE_EQ(exchange.E + (exchange.rho - 1) * H, q);
      EXPECT_EQ(net_flux(surface, H), q);
      EXPECT_NEAR(0.25 * (black_exitance(surface, H) - H), q, 1e-12);
    }
  }
}

/// A side with convection to air of 300 K.
ThermalSurface cooled(Emissivity emissivity, double heat_flux = 50) {
  return {std::move(emissivity), std::nullopt, heat_flux, 12, 300};
}

/// eps (sigma T^4 - H) - heat_flux - h (T_air - T), which the temperature makes 0.
double imbalance(const ThermalSurface& surface, double H) {
  const double T = temperature_of(black_exitance(surface, H));
  return emissivity_of(surface, H) * (black_exitance(surface, H) - H) - surface.heat_flux -
         surface.convection_coefficient * (surface.air_temperature - T);
}

const std::vector<EmissivityPoint> kRising{{250, 0.2}, {350, 0.3}, {900, 0.8}};

TEST(Thermal, WithConvectionTheTemperatureBalancesTheHeat) {
  for (const Emissivity& emissivity : {Emissivity(0.7), Emissivity(1), Emissivity(kRising)})
    for (const double H : {0.0, 1.0, 400.0, 5e3, 2e5}) {
      const ThermalSurface surface = cooled(emissivity);
      EXPECT_NEAR(imbalance(surface, H), 0, 1e-10 * (H + 3650)) << H;
      const double T = temperature_of(black_exitance(surface, H));
      EXPECT_NEAR(net_flux(surface, H), 50 + 12 * (300 - T), 1e-10 * (H + 3650)) << H;
    }
}

// As exact as double precision allows of a derivative by differences.
TEST(Thermal, WithConvectionTheExchangeIsTheTangent) {
  for (const Emissivity& emissivity : {Emissivity(0.7), Emissivity(1), Emissivity(kRising)})
    for (const double H : {100.0, 400.0, 5e3}) {
      const ThermalSurface surface = cooled(emissivity);
      const ThermalExchange tangent = linearised(surface, H);
      const double step = 1e-3 * H;
      const double above = H + step + net_flux(surface, H + step);
      const double below = H - step + net_flux(surface, H - step);
      EXPECT_NEAR(tangent.rho, (above - below) / (2 * step), 1e-5) << H;
      EXPECT_NEAR(tangent.E + tangent.rho * H, H + net_flux(surface, H), 1e-10 * (H + 3650)) << H;
    }
}

// The conductances of surface and linearised convection in series.
TEST(Thermal, ConvectionAbsorbsAsASeriesOfTwoConductances) {
  const ThermalSurface surface = cooled(0.7, 0);
  const double H = kStefanBoltzmann * std::pow(300.0, 4);  // of the air's temperature, and so is the side
  const double k = 12 / (4 * kStefanBoltzmann * std::pow(300.0, 3));
  EXPECT_NEAR(1 - linearised(surface, H).rho, 0.7 * k / (0.7 + k), 1e-12);
  EXPECT_NEAR(net_flux(surface, H), 0, 1e-9);
  EXPECT_EQ(first_irradiance(surface), H);
}

TEST(Thermal, MuchConvectionHoldsTheTemperatureOfTheAir) {
  const ThermalSurface held{0.7, std::nullopt, 0, 1e9, 300}, given{0.7, 300.0, 0};
  EXPECT_NEAR(linearised(held, 5e3).rho, linearised(given, 5e3).rho, 1e-6);
  EXPECT_NEAR(net_flux(held, 5e3), net_flux(given, 5e3), 1e-2);
  const ThermalSurface none{0.7, std::nullopt, 25, 1e-12, 300}, flux{0.7, std::nullopt, 25};
  EXPECT_NEAR(linearised(none, 5e3).rho, 1, 1e-9);
  EXPECT_NEAR(black_exitance(none, 5e3), black_exitance(flux, 5e3), 1e-6);
}

// What is drawn beyond what air and enclosure give to a side at 0 K.
TEST(Thermal, ADrainBelowAbsoluteZeroHasNoTemperature) {
  const ThermalSurface surface = cooled(0.5, -4000);  // the air gives 3600 W/m2
  EXPECT_GT(black_exitance(surface, 801), 0);
  EXPECT_LT(black_exitance(surface, 799), 0);
  EXPECT_EQ(linearised(surface, 799).E, 0);
  EXPECT_EQ(linearised(surface, 799).rho, 0.5);
  EXPECT_NEAR(linearised(surface, 801).rho, 0.5, 1e-3) << "no jump";
}

TEST(Thermal, EmissivityIsLinearBetweenPoints) {
  const Emissivity emissivity(kRising);
  EXPECT_EQ(emissivity.at(0), 0.2);
  EXPECT_EQ(emissivity.at(250), 0.2);
  EXPECT_DOUBLE_EQ(emissivity.at(300), 0.25);
  EXPECT_DOUBLE_EQ(emissivity.at(625), 0.55);
  EXPECT_EQ(emissivity.at(900), 0.8);
  EXPECT_EQ(emissivity.at(5000), 0.8);
  EXPECT_EQ(emissivity.slope_at(200), 0);
  EXPECT_DOUBLE_EQ(emissivity.slope_at(300), 1e-3);
  EXPECT_EQ(emissivity.slope_at(900), 0);
  EXPECT_EQ(emissivity.least(), 0.2);
  EXPECT_DOUBLE_EQ(linearised({emissivity, 300.0}, 0).rho, 0.75) << "of a given temperature, that one's";
}

// A fall within a kelvin, where more is absorbed than the air takes: rho stays what a reflectance can be.
TEST(Thermal, ASteepEmissivityKeepsTheReflectanceWithinItsBounds) {
  const ThermalSurface surface = cooled(Emissivity({{350, 0.9}, {351, 0.1}}), 0);
  for (double H = 800; H < 9000; H += 50) {
    const double rho = linearised(surface, H).rho;
    EXPECT_GE(rho, 0) << H;
    EXPECT_LE(rho, 1) << H;
    EXPECT_NEAR(imbalance(surface, H), 0, 1e-8) << H;
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

TEST(Thermal, ConvectionMustSayEnough) {
  const InputHeat enough{0.75, 1000.0, {}};
  expect_words(error_of(cube(enough, {0.5, {}, {}, 10.0})), {"'others' has no air_temperature"});
  expect_words(error_of(cube(enough, {0.5, {}, 10.0, {}, 300.0})),
               {"'others' has no convection_coefficient"});
  expect_words(error_of(cube(enough, {{}, {}, {}, 10.0, 300.0})), {"'others' has no emissivity"});
  EXPECT_EQ(error_of(cube(enough, {0.5, {}, {}, 10.0, 300.0})), "no error");
  EXPECT_EQ(error_of(cube({{}, {}, 7.0}, {0.5, {}, {}, 10.0, 300.0})), "no error")
      << "air determines temperatures too";
  expect_words(error_of(cube({{}, {}, -1.8e4}, {0.5, {}, {}, 10.0, 300.0})),
               {"the prescribed fluxes draw 18000 W", "no more than 15000 W"});
}

TEST(Thermal, ATemperatureReplacesConvectionAndTheOtherWayRound) {
  InputHeat heat{0.75, {}, 5.0, 10.0, 300.0};
  replace_heat({{}, 400.0}, heat);
  EXPECT_EQ(heat, (InputHeat{0.75, 400.0}));
  replace_heat({{}, {}, {}, 20.0}, heat);
  EXPECT_EQ(heat, (InputHeat{0.75, {}, {}, 20.0}));
  replace_heat({0.5, {}, 8.0, {}, 290.0}, heat);
  EXPECT_EQ(heat, (InputHeat{0.5, {}, 8.0, 20.0, 290.0}));
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
