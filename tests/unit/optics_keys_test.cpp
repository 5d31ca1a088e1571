#include "scene/readers/optics_keys.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include "tests/unit/messages.hpp"
#include "tests/unit/scene_text.hpp"

namespace fluxel {
namespace {

namespace scene_text = test_scene_text;
using test_messages::expect_words;

const std::string kOfWhite =
    scene_text::kGeometry + "[materials.white]\n";  // rho 0.5 by its file; keys begin in line 4

TEST(OpticsKeys, SharesAreNumbersOrColours) {
  const SceneInput scene =
      scene_text::read(kOfWhite +
                       "rho = [0.25, 0.5, 0]\nmirror = 0.25\n"
                       "transmission = [0.5, 0.125, 0.25]\ndiffuse_transmission = [0, 0.125, 0.5]\n");
  const InputMaterial& white = scene.materials[0];
  EXPECT_EQ(white.rho, Rgb(0.25, 0.5, 0));
  EXPECT_EQ(white.optics, (SurfaceOptics{Rgb(0.25), Rgb(0.5, 0.125, 0.25), Rgb(0, 0.125, 0.5), 0}));
  EXPECT_EQ(white.optics_line, 7u) << "the last key's";
  EXPECT_EQ(scene.materials[1].optics, SurfaceOptics{});
  EXPECT_EQ(scene.materials[1].optics_line, 0u);
}

TEST(OpticsKeys, ClearBodiesReflectByTheirIndexAlone) {
  const InputMaterial white = scene_text::read(kOfWhite + "refraction_index = 1.5\n").materials[0];
  EXPECT_EQ(white.rho, Rgb(0)) << "in place of its file's";
  EXPECT_EQ(white.optics, (SurfaceOptics{Rgb(0), Rgb(0), Rgb(0), 1.5}));
  EXPECT_EQ(white.optics_line, 4u);
  EXPECT_EQ(scene_text::read(kOfWhite + "refraction_index = 1\n").materials[0].optics.refraction_index, 1);
  EXPECT_EQ(scene_text::read(kOfWhite + "refraction_index = 10\n").materials[0].optics.refraction_index, 10);
}

TEST(OpticsKeys, RefusesSharesOutsideOf0To1) {
  for (const std::string key : {"mirror", "transmission", "diffuse_transmission"}) {
    expect_words(scene_text::error_of(kOfWhite + "rho = 0\n" + key + " = 1.5\n"),
                 {"scene.toml:5:", "[materials.white] " + key, "share outside 0..1"});
    expect_words(scene_text::error_of(kOfWhite + key + " = [0.1, -0.1, 0]\n"),
                 {":4:", key, "share outside 0..1"});
    expect_words(scene_text::error_of(kOfWhite + key + " = nan\n"), {":4:", key, "finite"});
    expect_words(scene_text::error_of(kOfWhite + key + " = \"all\"\n"), {":4:", key, "must be a number"});
    expect_words(scene_text::error_of(kOfWhite + key + " = [0.1, 0.1]\n"), {":4:", key, "array of 3"});
  }
}

TEST(OpticsKeys, RefusesSharesOfMoreThanArrives) {
  expect_words(scene_text::error_of(kOfWhite + "mirror = 0.6\n"),
               {"scene.toml:4:", "[materials.white]: rho, mirror, transmission and diffuse_transmission",
                "add up to 1.1", "rho is 0.5 by the geometry's file"});
  const std::string given = scene_text::error_of(
      kOfWhite + "rho = 0.25\nmirror = 0.25\ntransmission = 0.25\ndiffuse_transmission = [0, 0.5, 0]\n");
  expect_words(given, {":7:", "add up to 1.25", "rho is 0.25"});
  EXPECT_EQ(given.find("geometry's file"), std::string::npos) << given;
  EXPECT_EQ(scene_text::error_of(kOfWhite +
                                 "rho = 0.1\nmirror = 0.2\ntransmission = 0.4\ndiffuse_transmission = 0.3\n"),
            "no error")
      << "decimals that add up to 1 but for rounding";
}

TEST(OpticsKeys, RefusesIndicesOfRefraction) {
  for (const std::string value : {"0.99", "0", "-1.5", "10.5"})
    expect_words(scene_text::error_of(kOfWhite + "refraction_index = " + value + "\n"),
                 {"scene.toml:4:", "[materials.white] refraction_index is " + value, "from 1 to 10"});
  expect_words(scene_text::error_of(kOfWhite + "refraction_index = nan\n"), {":4:", "finite"});
  expect_words(scene_text::error_of(kOfWhite + "refraction_index = [1.5, 1.5, 1.5]\n"),
               {":4:", "must be a number"});
}

TEST(OpticsKeys, RefusesAnythingBesideAnIndexOfRefraction) {
  for (const std::string other : {"rho = 0.1", "E = 1", "sides = \"two\"", "mirror = 0.1",
                                  "transmission = 0.1", "diffuse_transmission = 0.1", "temperature = 300"}) {
    const std::string key = other.substr(0, other.find(' '));
    expect_words(scene_text::error_of(kOfWhite + "refraction_index = 1.5\n" + other + "\n"),
                 {"scene.toml:5:", "[materials.white] has " + key + " beside refraction_index"});
  }
  expect_words(scene_text::error_of(scene_text::kGeometry + "[materials.light]\nrefraction_index = 1.5\n"),
               {"scene.toml:4:", "[materials.light] emits by its file's Ke"});
}

TEST(OpticsKeys, RefusesSharesBesideATextureWithoutRho) {
  // As readers of files with textures leave it.
  SceneInput scene = scene_text::read(scene_text::kGeometry);
  InputMaterial& white = scene.materials[0];
  white.textured = true;
  const std::filesystem::path file = "dir/scene.toml";
  const TomlFile toml{file};
  const auto said = [&](const std::string& keys) -> std::string {
    const toml::table table = toml::parse(keys);
    try {
      read_optics(toml, table, "[materials.white]", white);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  expect_words(said("mirror = 0.1"),
               {"scene.toml:1:", "[materials.white] has a texture of its own reflectance", "give its rho"});
  EXPECT_EQ(said("rho = 0.5\nmirror = 0.1"), "no error");
  EXPECT_EQ(said("sides = \"two\""), "no error");
}

}  // namespace
}  // namespace fluxel
