#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "core/error.hpp"
#include "core/options.hpp"
#include "scene/readers/scene_file.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::luminaire_table_test {
namespace {

using test_messages::expect_words;

constexpr double kPi = std::numbers::pi;

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
const std::string kLamp = "TILT=NONE\n1 1000 1 2 1 1 2 0.3 1.2 0 1 1 50 0 180 0 100 100\n";  // 400 pi lm
const std::string kWatts = "[_INTENSITYUNITS] mW/sr\n" + kLamp;
const std::string kScene = "[[geometry]]\nfile = \"a.obj\"\n";
const std::string kLuminaire = "[[luminaires]]\nname = \"lamp\"\nfile = \"lamp.ies\"\nposition = [1, 2, 3]\n";

/// The files that were read, of which a test may look at the count.
std::map<std::string, int> lookups;

/// `head`: keys of the scene file itself.
SceneInput read(const std::string& luminaires, const std::string& head = {}) {
  const std::map<std::string, std::string> files = {
      {"dir/a.obj", kObj}, {"dir/lamp.ies", kLamp}, {"dir/uv.ies", kWatts}, {"dir/bad.ldt", "no\n"}};
  lookups.clear();
  return read_scene_text("dir/s.toml", head + kScene + luminaires, [&](const std::filesystem::path& path) {
    ++lookups[path.string()];
    const auto found = files.find(path.string());
    return found == files.end() ? std::nullopt : std::optional(found->second);
  });
}

std::string error_of(const std::string& luminaires, const std::string& head = {}) {
  try {
    static_cast<void>(read(luminaires, head));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

Luminaire read_one(const std::string& keys) { return read(kLuminaire + keys).luminaires.at(0); }

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-12)
      << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

TEST(LuminaireTable, ReadsALuminaireOfAFile) {
  const SceneInput scene = read(kLuminaire);
  ASSERT_EQ(scene.luminaires.size(), 1u);
  const Luminaire& lamp = scene.luminaires[0];
  EXPECT_EQ(lamp.name, "lamp");
  EXPECT_EQ(lamp.position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(lamp.aim, glm::dvec3(0, -1, 0));
  EXPECT_EQ(lamp.ahead, glm::dvec3(1, 0, 0));
  EXPECT_EQ(lamp.size, glm::dvec2(1.2, 0.3));
  EXPECT_FALSE(lamp.round);
  EXPECT_EQ(lamp.scale, Rgb(1));
  ASSERT_EQ(scene.intensities.size(), 1u);
  EXPECT_NEAR(flux(scene.intensities[0]), 400 * kPi, 1e-9);
  EXPECT_EQ(scene.units, Units::photometric);
  EXPECT_TRUE(read("").luminaires.empty());
  EXPECT_FALSE(read("").units.has_value());
}

TEST(LuminaireTable, ReadsAFileOnce) {
  const SceneInput scene = read(kLuminaire +
                                "[[luminaires]]\nname = \"b\"\nfile = \"./lamp.ies\"\nposition = [0, 0, 0]\n"
                                "[[luminaires]]\nname = \"c\"\nintensity = 5\nposition = [0, 0, 0]\n");
  ASSERT_EQ(scene.luminaires.size(), 3u);
  EXPECT_EQ(scene.intensities.size(), 2u);
  EXPECT_EQ(scene.luminaires[1].intensity, 0u);
  EXPECT_EQ(scene.luminaires[2].intensity, 1u);
  EXPECT_EQ(lookups["dir/lamp.ies"], 1);
}

TEST(LuminaireTable, ReadsAnIsotropicLuminaire) {
  const SceneInput scene = read("[[luminaires]]\nname = \"p\"\nintensity = 100.0\nposition = [0, 0, 0]\n");
  EXPECT_NEAR(flux(scene.intensities.at(0)), 400 * kPi, 1e-9);
  EXPECT_EQ(intensity(scene.intensities[0], 2, kPi), 100);
  EXPECT_EQ(scene.luminaires.at(0).size, glm::dvec2(0));
  EXPECT_EQ(scene.units, Units::photometric);
}

TEST(LuminaireTable, SetsFluxMaintenanceAndSize) {
  EXPECT_NEAR(read_one("flux = 1000\n").scale.r, 1000 / (400 * kPi), 1e-12);
  EXPECT_NEAR(read_one("flux = 1000\nmaintenance_factor = 0.8\n").scale.g, 800 / (400 * kPi), 1e-12);
  EXPECT_EQ(read_one("maintenance_factor = 1\n").scale, Rgb(1));
  EXPECT_EQ(read_one("size = [0.5, 0.25]\n").size, glm::dvec2(0.5, 0.25));
  EXPECT_FALSE(read_one("size = [0.5, 0.25]\n").round);
  EXPECT_EQ(read_one("size = 0.5\n").size, glm::dvec2(0.5));
  EXPECT_TRUE(read_one("size = 0.5\n").round);
  EXPECT_EQ(read_one("size = 0\n").size, glm::dvec2(0));
  EXPECT_FALSE(read_one("size = 0\n").round);
}

// Seen along the aim, C turns clockwise; from above a luminaire that looks down, counter-clockwise (LM-63).
TEST(LuminaireTable, TurnsC0TowardsC90) {
  expect_near(read_one("turn = 0\n").ahead, {1, 0, 0});
  expect_near(read_one("turn = 90\n").ahead, {0, 0, -1});
  expect_near(read_one("turn = -270\n").ahead, {0, 0, -1});
  expect_near(read_one("turn = 30\n").ahead, {std::cos(kPi / 6), 0, -0.5});
  expect_near(read_one("aim = [0, 5, 0]\nturn = 90\n").ahead, {0, 0, 1});
}

TEST(LuminaireTable, LeavesC0NearTheXAxis) {
  for (const std::string aim : {"[0, -1e200, 0]", "[0, 0, 1]", "[3, -2, 1]", "[-1, 1e-3, 0]"}) {
    const Luminaire lamp = read_one("aim = " + aim + "\n");
    EXPECT_NEAR(glm::length(lamp.aim), 1, 1e-14);
    EXPECT_NEAR(glm::length(lamp.ahead), 1, 1e-14);
    EXPECT_NEAR(glm::dot(lamp.ahead, lamp.aim), 0, 1e-14) << aim;
    EXPECT_NEAR(glm::dot(glm::cross(lamp.aim, lamp.ahead), {1, 0, 0}), 0, 1e-12)
        << aim;  // in the plane of x and aim
    EXPECT_GT(lamp.ahead.x, 0) << aim;
  }
  expect_near(read_one("aim = [-1, 0, 0]\n").ahead, {0, 1, 0});
  expect_near(read_one("aim = [2, 1e-9, 0]\n").ahead, {0, 1, 0});
}

TEST(LuminaireTable, TurnsC0TowardsADirection) {
  expect_near(read_one("turn = [0, 0, 2]\n").ahead, {0, 0, 1});
  expect_near(read_one("turn = [0, 7, -1]\n").ahead, {0, 0, -1});  // the part along the aim does not count
  expect_near(read_one("aim = [1, 0, 0]\nturn = [0, 1e-100, 1e-100]\n").ahead,
              glm::normalize(glm::dvec3(0, 1, 1)));
}

TEST(LuminaireTable, MakesArrays) {
  const SceneInput scene =
      read(kLuminaire + "rows = 2\ncolumns = 3\nrow_step = [0, 0, 2]\ncolumn_step = [1.5, 0, 0]\n");
  ASSERT_EQ(scene.luminaires.size(), 6u);
  EXPECT_EQ(scene.intensities.size(), 1u);
  EXPECT_EQ(scene.luminaires[0].name, "lamp-1-1");
  EXPECT_EQ(scene.luminaires[0].position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(scene.luminaires[5].name, "lamp-2-3");
  EXPECT_EQ(scene.luminaires[5].position, glm::dvec3(4, 2, 5));
  EXPECT_EQ(read(kLuminaire + "rows = 1\n").luminaires.at(0).name, "lamp-1-1");
}

TEST(LuminaireTable, ConvertsUnitsByAStatedEfficacy) {
  const std::string watts = "[[luminaires]]\nname = \"uv\"\nfile = \"uv.ies\"\nposition = [0, 0, 0]\n";
  const SceneInput alone = read(watts);
  const SceneInput converted = read(watts, "units = \"photometric\"\nluminous_efficacy = 100\n");
  EXPECT_EQ(converted.units, Units::photometric);
  EXPECT_DOUBLE_EQ(converted.intensities[0].intensity[0], 100 * alone.intensities[0].intensity[0]);
  const SceneInput lumens = read(kLuminaire);
  const SceneInput back = read(kLuminaire, "units = \"radiometric\"\nluminous_efficacy = 100\n");
  EXPECT_DOUBLE_EQ(back.intensities[0].intensity[0], lumens.intensities[0].intensity[0] / 100);
  for (const char* efficacy : {"0", "-1", "684", "nan"})
    expect_words(error_of(watts, std::string("luminous_efficacy = ") + efficacy + "\n"),
                 {"dir/s.toml:1:", "luminous_efficacy"});
  expect_words(error_of(watts, "units = \"lumens\"\n"),
               {"dir/s.toml:1:", "'lumens'", "radiometric or photometric"});
}

TEST(LuminaireTable, RefusesUnitsThatDiffer) {
  const std::string watts = "[[luminaires]]\nname = \"uv\"\nfile = \"uv.ies\"\nposition = [0, 0, 0]\n";
  EXPECT_EQ(read(watts).units, Units::radiometric);
  expect_words(error_of(kLuminaire + watts), {"dir/s.toml:9:", "dir/uv.ies is radiometric",
                                              "dir/lamp.ies is photometric", "luminous_efficacy"});
  expect_words(error_of(watts + kLuminaire),
               {"dir/s.toml:9:", "dir/lamp.ies is photometric", "dir/uv.ies is radiometric"});
  expect_words(error_of(watts + "[[luminaires]]\nname = \"p\"\nintensity = 1\nposition = [0, 0, 0]\n"),
               {":9:", "candelas", "dir/uv.ies is radiometric"});
}

struct BadKey {
  const char* from;
  const char* to;
  std::vector<std::string> words;
};

TEST(LuminaireTable, RefusesBadTables) {
  for (const BadKey& bad : {
           BadKey{"[[luminaires]]", "[luminaires]", {":3:", "[[luminaires]]"}},
           BadKey{"name = \"lamp\"\n", "", {":3:", "lacks name"}},
           BadKey{"\"lamp\"", "\"\"", {":4:", "name is empty"}},
           BadKey{"\"lamp\"", "3", {":4:", "text"}},
           BadKey{"position = [1, 2, 3]\n", "", {":3:", "lacks position"}},
           BadKey{"[1, 2, 3]", "[1, 2]", {":6:", "array of 3"}},
           BadKey{"[1, 2, 3]", "[1, 2, inf]", {":6:", "finite"}},
           BadKey{"[1, 2, 3]", "[1, 2, 1e200]", {":3:", "'lamp' is too far away"}},
           BadKey{"file = \"lamp.ies\"\n", "", {":3:", "one of file and intensity"}},
           BadKey{"\"lamp.ies\"", "\"lamp.ies\"\nintensity = 5", {":3:", "one of file and intensity"}},
           BadKey{"\"lamp.ies\"", "\"none.ies\"", {":5:", "cannot find", "dir/none.ies"}},
           BadKey{"\"lamp.ies\"", "\"a.obj\"", {":5:", "'dir/a.obj' is no photometric file", ".ies, .ldt"}},
           BadKey{"\"lamp.ies\"", "\"bad.ldt\"", {"dir/bad.ldt:1:", "ends before"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\naims = 1", {":7:", "'aims'", "aim, turn"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\naim = [0, 0, 0]", {":7:", "aim has no direction"}},
           BadKey{"[1, 2, 3]",
                  "[1, 2, 3]\naim = [0, 1, 0]\nturn = [0, -3, 0]",
                  {":8:", "turn is parallel to its aim"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nturn = [0, 3, 1e-9]", {":7:", "turn is parallel to its aim"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nturn = [0, 0, 0]", {":7:", "turn has no direction"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nturn = \"x\"", {":7:", "number"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nflux = 0", {":7:", "flux must be greater than 0"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nflux = -5", {":7:", "greater than 0"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nmaintenance_factor = 1.5", {":7:", "1 at most"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nmaintenance_factor = 0", {":7:", "greater than 0"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nsize = -1", {":7:", "between 0 and 10000 m"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nsize = [1, 2, 3]", {":7:", "array of 2"}},
           BadKey{
               "[1, 2, 3]", "[1, 2, 3]\nrows = 0", {":7:", "rows must be a whole number from 1 to 100000"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nrows = 2.5", {":7:", "whole number"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nrows = 1000000000000", {":7:", "whole number"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nrows = 2", {":3:", "lacks row_step"}},
           BadKey{"[1, 2, 3]",
                  "[1, 2, 3]\nrows = 2\nrow_step = [0, 0, 0]",
                  {":8:", "row_step is 0", "2 luminaires in one place"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\nturn = 1e300", {":7:", "turn", "36000"}},
           BadKey{"[1, 2, 3]", "[1, 2, 3]\ncolumns = 2", {":3:", "lacks column_step"}},
           BadKey{"[1, 2, 3]",
                  "[1, 2, 3]\nrows = 1000\ncolumns = 101\nrow_step = [1, 0, 0]\ncolumn_step = [0, 0, 1]",
                  {":3:", "more than 100000 luminaires"}},
       }) {
    std::string text = kLuminaire;
    const std::size_t at = text.find(bad.from);
    ASSERT_NE(at, std::string::npos) << bad.from;
    expect_words(error_of(text.replace(at, std::string(bad.from).size(), bad.to)), bad.words);
  }
  expect_words(error_of("[luminaires]\n"), {":3:", "luminaires must stand as [[luminaires]]"});
  expect_words(error_of("[materials]\n[[luminaires]]\n"), {":4:", "one of file and intensity"});
  expect_words(error_of(kLuminaire + kLuminaire), {":7:", "a second luminaire 'lamp'"});
  expect_words(error_of("[[luminaires]]\nname = \"p\"\nposition = [0, 0, 0]\nintensity = 0\n"),
               {":6:", "intensity must be greater than 0"});
  expect_words(error_of("[[luminaires]]\nname = \"p\"\nposition = [0, 0, 0]\nintensity = 1\nflux = 1\n"),
               {":7:", "say the same"});
  expect_words(
      error_of(kLuminaire + "rows = 50000\nrow_step = [1, 0, 0]\n" + "[[luminaires]]\nname = \"b\"\n" +
               "intensity = 1\nposition = [0, 0, 0]\nrows = 50001\nrow_step = [1, 0, 0]\n"),
      {":9:", "more than 100000"});
}

}  // namespace
}  // namespace fluxel::luminaire_table_test
