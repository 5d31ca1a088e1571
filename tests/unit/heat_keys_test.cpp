#include "scene/readers/heat_keys.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include "tests/unit/messages.hpp"
#include "tests/unit/scene_text.hpp"

namespace fluxel {
namespace {

using test_messages::expect_words;
using test_scene_text::error_of;
using test_scene_text::Files;
using test_scene_text::kBox;
using test_scene_text::kGeometry;
using test_scene_text::read;

TEST(HeatKeys, HeatReplacesWhatTheMtlSays) {
  const Files files = {{"dir/box.obj", kBox},
                       {"dir/box.mtl",
                        "newmtl white\nKd 0.5\nemissivity 0.8\ntemperature 300\n"
                        "newmtl light\nKd 0\nheat_flux 5\n"}};
  EXPECT_EQ(read(kGeometry, files).materials[0].heat, (InputHeat{0.8, 300.0, {}}));
  const SceneInput scene = read(kGeometry +
                                    "[materials.white]\nheat_flux = -20\n"
                                    "[materials.light]\nemissivity = 0.25\ntemperature = 900.5\n",
                                files);
  EXPECT_EQ(scene.materials[0].heat, (InputHeat{0.8, {}, -20.0}));
  EXPECT_EQ(scene.materials[1].heat, (InputHeat{0.25, 900.5, {}}));
  const SceneInput emissivity = read(kGeometry + "[materials.light]\nemissivity = 0.5\n", files);
  EXPECT_EQ(emissivity.materials[1].heat, (InputHeat{0.5, {}, 5.0}));
}

TEST(HeatKeys, RefusesBadHeat) {
  const std::string start = kGeometry + "[materials.white]\n";
  expect_words(error_of(start + "emissivity = 0\n"),
               {"scene.toml:4:", "[materials.white] emissivity", "1e-6..1"});
  expect_words(error_of(start + "emissivity = 1.5\n"), {":4:", "1e-6..1"});
  expect_words(error_of(start + "emissivity = [1, 1, 1]\n"), {":4:", "must be a number"});
  expect_words(error_of(start + "temperature = \"hot\"\n"), {":4:", "temperature must be a number"});
  expect_words(error_of(start + "temperature = -0.5\n"), {":4:", "below 0 kelvin"});
  expect_words(error_of(start + "temperature = 1e6\n"), {":4:", "too large"});
  expect_words(error_of(start + "heat_flux = inf\n"), {":4:", "heat_flux must be finite"});
  expect_words(error_of(start + "heat_flux = 1e16\n"), {":4:", "too large"});
  expect_words(error_of(start + "heat_flux = 0\ntemperature = 1\n"), {":4:", "heat_flux", "either"});
}

TEST(HeatKeys, EmissivityByTemperature) {
  const std::string start = kGeometry + "[materials.white]\n";
  const SceneInput scene = read(start + "emissivity = [[300, 0.2], [900.5, 0.4]]\n");
  EXPECT_EQ(scene.materials[0].heat, InputHeat{Emissivity({{300, 0.2}, {900.5, 0.4}})});
  EXPECT_EQ(read(start + "emissivity = [[300, 0.2]]\n").materials[0].heat,
            InputHeat{Emissivity({{300, 0.2}})});
  expect_words(error_of(start + "emissivity = []\n"), {":4:", "[materials.white] emissivity", "empty"});
  expect_words(error_of(start + "emissivity = [[300, 0.2], [900]]\n"),
               {":4:", "must be a number, or pairs [temperature, emissivity]", "in kelvin"});
  expect_words(error_of(start + "emissivity = [[300, 0.2], [300, 0.4]]\n"), {":4:", "do not rise"});
  expect_words(error_of(start + "emissivity = [[300, 0.2], [400, 1.4]]\n"), {":4:", "outside 1e-6..1"});
  expect_words(error_of(start + "emissivity = [[-1, 0.2], [400, 0.4]]\n"),
               {":4:", "for a temperature that is below 0 kelvin"});
  expect_words(error_of(start + "emissivity = [[300, \"low\"]]\n"), {":4:", "must be a number"});
}

TEST(HeatKeys, TemperaturesInCelsius) {
  const std::string start = "temperature_unit = \"celsius\"\n" + kGeometry + "[materials.white]\n";
  const SceneInput scene =
      read(start + "emissivity = [[0, 0.2], [100, 0.4]]\nair_temperature = 20\nconvection_coefficient = 5\n");
  EXPECT_EQ(scene.temperature_unit, TemperatureUnit::celsius);
  EXPECT_EQ(scene.materials[0].heat,
            (InputHeat{Emissivity({{273.15, 0.2}, {373.15, 0.4}}), {}, {}, 5.0, 293.15}));
  EXPECT_EQ(read(start + "temperature = -273.15\n").materials[0].heat.temperature, 0);
  expect_words(error_of(start + "temperature = -274\n"), {":5:", "below -273.15 degrees Celsius"});
  expect_words(error_of(start + "temperature = 1e5\n"), {":5:", "at most 99726.85 degrees Celsius"});
  expect_words(error_of(start + "emissivity = [[-300, 0.2], [400, 0.4]]\n"),
               {":5:", "below -273.15 degrees Celsius"});
  EXPECT_EQ(read("temperature_unit = \"kelvin\"\n" + kGeometry).temperature_unit, TemperatureUnit::kelvin);
  expect_words(error_of("temperature_unit = \"C\"\n" + kGeometry),
               {"scene.toml:1:", "temperature_unit is 'C'", "kelvin or celsius"});
  const Files files = {{"dir/box.obj", kBox},
                       {"dir/box.mtl", "newmtl white\nKd 0.5\ntemperature 300\nnewmtl light\nKd 0\n"}};
  EXPECT_EQ(read(start + "emissivity = 0.5\n", files).materials[0].heat.temperature, 300)
      << "MTL files are in kelvin";
}

TEST(HeatKeys, OneMaterialOfTwoFilesHasOneHeat) {
  const auto mtl = [](const std::string& heat) { return "newmtl white\nKd 0.5\n" + heat; };
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl white\nf 1 2 3\n";
  const Files files = {{"dir/a.obj", "mtllib a.mtl\n" + obj},
                       {"dir/a.mtl", mtl("heat_flux 0\n")},
                       {"dir/b.obj", "mtllib b.mtl\n" + obj},
                       {"dir/b.mtl", mtl("heat_flux 1\n")}};
  expect_words(error_of("[[geometry]]\nfile = \"a.obj\"\n[[geometry]]\nfile = \"b.obj\"\n", files),
               {"material 'white' has one value in dir/a.obj and another in dir/b.obj"});
}

}  // namespace
}  // namespace fluxel
