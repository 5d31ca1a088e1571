#include "scene/readers/radiance_reader.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "scene/to_patches.hpp"
#include "tests/unit/messages.hpp"
#include "tests/unit/read_bytes.hpp"

namespace fluxel::radiance_reader_test {
namespace {

using std::numbers::pi;
using test_messages::expect_words;
using test_readers::area_of;
using test_readers::area_vector;

SceneInput read(const std::string& text) {
  return test_readers::read_bytes(read_radiance, "dir/a.rad", text);
}
std::string error_of(const std::string& text) {
  return test_readers::error_of(read_radiance, "dir/a.rad", text);
}

const std::string kGrey = "void plastic grey\n0\n0\n5 0.5 0.4 0.3 0 0\n";
const std::string kTriangle = "grey polygon wall.1 0 0 9 0 0 0 1 0 0 0 1 0\n";

/// The material of a scene whose one surface is of modifier `m`.
InputMaterial material_of(const std::string& definitions) {
  const SceneInput scene = read(definitions + "m polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n");
  return scene.materials[index(scene.polygons.at(0).material)];
}

std::vector<std::string> notes_of(const std::string& text) { return read(text).notes; }

TEST(RadianceReader, ReadsPolygonsGroupsAndMaterials) {
  const SceneInput scene =
      read("# a comment\n\nvoid plastic white 0 0 5 .7 7e-1 +.65 0.1 0.05\n" + kGrey +
           "white polygon wall.1\n0\n0\n12\n\t0 0 0\n 1 0 0 # a comment\r\n 1 1 0\n 0 1 0\n" + kTriangle);
  EXPECT_EQ(scene.name, "a");
  ASSERT_EQ(scene.polygons.size(), 2u);
  EXPECT_EQ(scene.polygons[0].corners, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(scene.groups, std::vector<std::string>{"wall.1"});
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "white");
  EXPECT_DOUBLE_EQ(scene.materials[0].rho.r, 0.9 * 0.7);
  EXPECT_DOUBLE_EQ(scene.materials[0].rho.b, 0.9 * 0.65);
  EXPECT_EQ(scene.materials[0].sides, Sides::two);
  EXPECT_FALSE(scene.materials[0].E);
  EXPECT_EQ(scene.materials[1].rho, Rgb(0.5, 0.4, 0.3));
  EXPECT_EQ(index(scene.polygons[1].material), 1u);
  EXPECT_FALSE(scene.units);
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"dir/a.rad", "only the diffuse part", "plastic 'white' (line 3)"});
}

TEST(RadianceReader, TakesTheDiffusePartOfMaterials) {
  const auto rho = [](const std::string& type, const std::string& arguments) {
    return material_of("void " + type + " m " + arguments + "\n").rho;
  };
  const auto expect_rho = [](const Rgb& found, const Rgb& expected) {
    for (int c = 0; c < kChannels; ++c) EXPECT_DOUBLE_EQ(found[c], expected[c]);
  };
  expect_rho(rho("plastic2", "4 ux uy uz . 0 6 0.5 0.4 0.3 0.5 0.1 0.2"), {0.25, 0.2, 0.15});
  expect_rho(rho("plasfunc", "2 refl . 0 5 0.5 0.4 0.3 0.5 7"), {0.25, 0.2, 0.15});
  expect_rho(rho("metal", "0 0 5 0.5 0.4 0.3 0.9 0.1"), {0.5, 0.4, 0.3});
  expect_rho(rho("mirror", "0 0 3 0.5 0.4 0.3"), {0.5, 0.4, 0.3});
  // (1 - spec) (1 - trans) of the colour.
  expect_rho(rho("trans", "0 0 7 0.8 0.4 0.2 0.5 0.1 0.25 0.9"), {0.3, 0.15, 0.075});
  expect_rho(rho("trans2", "4 ux uy uz . 0 8 0.8 0.4 0.2 0.5 0.1 0.9 0.25 0.9"), {0.3, 0.15, 0.075});
  expect_rho(rho("transfunc", "2 brtd . 0 6 0.8 0.4 0.2 0.5 0.25 0.9"), {0.3, 0.15, 0.075});
  expect_rho(rho("BRTDfunc", "10 a b c d e f 0 0 0 . 0 9 0.5 0.4 0.3 0 0 0 0 0 0"), {0.5, 0.4, 0.3});
  expect_rho(rho("ashik2", "4 ux uy uz . 0 8 0.5 0.4 0.3 0.5 0.25 0 9 9"), {0.25, 0.3, 0.3});
}

TEST(RadianceReader, LightsEmitPiTimesTheirRadiance) {
  for (const char* const light : {"light m 0 0 3 1 2 4", "glow m 0 0 4 1 2 4 0", "illum m 1 void 0 3 1 2 4",
                                  "illum m 0 0 3 1 2 4", "spotlight m 0 0 7 1 2 4 30 0 0 -1"}) {
    const InputMaterial material = material_of(std::string("void ") + light + "\n");
    ASSERT_TRUE(material.E) << light;
    EXPECT_DOUBLE_EQ(material.E->g, 2 * pi) << light;
    EXPECT_EQ(material.rho, Rgb(0)) << light;
  }
  const SceneInput scene = read("void spotlight m 0 0 7 1 2 4 30 0 0 -1\nm ring r 0 0 8 0 0 0 0 0 -1 0 1\n");
  EXPECT_EQ(scene.units, Units::radiometric);
  expect_words(scene.notes.at(0), {"spotlights emit in all directions", "'m' (line 1)"});
  EXPECT_EQ(material_of(kGrey + "void illum m 1 grey 0 3 1 2 4\n").rho, Rgb(0.5, 0.4, 0.3));
  EXPECT_FALSE(material_of("void glow m 0 0 4 1 2 4 -1\n").E);
}

TEST(RadianceReader, FollowsPatternsMixturesAndAliases) {
  EXPECT_EQ(material_of(kGrey + "grey brightfunc m 2 bright a.cal 0 1 0.5\n").name, "grey");
  EXPECT_EQ(material_of(kGrey + "void alias m grey\n").name, "grey");
  EXPECT_EQ(material_of(kGrey + "inherit alias m grey\n").name, "grey");
  EXPECT_EQ(material_of(kGrey + "void mixfunc m 4 void grey half . 0 0\n").name, "grey");
  EXPECT_EQ(material_of(kGrey + "void brightfunc b 2 x . 0 0\ngrey mixfunc m 4 b b half . 0 0\n").name,
            "grey");
  EXPECT_EQ(material_of("void brightfunc b 2 x . 0 0\nb plastic m 0 0 5 0.5 0.5 0.5 0 0\n").name, "m");
  const std::vector<std::string> notes =
      notes_of(kGrey + "grey texfunc t 4 x y z . 0 0\nt polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n");
  expect_words(notes.at(0), {"patterns and textures are ignored", "texfunc 't' (line 5)"});
}

TEST(RadianceReader, TheLastDefinitionBeforeASurfaceCounts) {
  const SceneInput scene = read(kGrey + kTriangle + "void plastic grey 0 0 5 0.1 0.1 0.1 0 0\n" + kTriangle +
                                kGrey + kTriangle + kGrey + kTriangle);
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.materials[0].name, "grey");
  EXPECT_EQ(scene.materials[1].name, "grey (2)");
  EXPECT_EQ(scene.materials[2].name, "grey (3)");
  std::vector<std::size_t> used;
  for (const InputPolygon& polygon : scene.polygons) used.push_back(index(polygon.material));
  EXPECT_EQ(used, (std::vector<std::size_t>{0, 1, 2, 2}));
}

TEST(RadianceReader, NeverRunsCommands) {
  const SceneInput scene = read("\xEF\xBB\xBF!genbox grey box 1 2 3 \\\n  | xform \\\n -rx 90\n" + kGrey +
                                "! touch /tmp/x\\\n\n" + kTriangle + "!last \\");
  ASSERT_EQ(scene.polygons.size(), 1u);
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"commands are not run", "xform", "line 1 '!genbox grey box 1 2 3 \\'",
                                "line 8 '! touch /tmp/x\\'", "line 11 '!last \\'"});
  expect_words(error_of("!xform a.rad\n"),
               {"holds no surface", "commands are not run", "line 1 '!xform a.rad'"});
}

TEST(RadianceReader, LeavesOutWhatIsNotInTheScene) {
  const SceneInput scene = read(
      "void glow sky 0 0 4 1 1 1 0\nsky source above 0 0 4 0 0 1 180\nvoid instance trees 1 trees.oct 0 0\n" +
      kGrey + kTriangle);
  ASSERT_EQ(scene.polygons.size(), 1u);
  expect_words(scene.notes.at(0), {"left out", "line 2 source 'above'", "line 3 instance 'trees'"});
}

TEST(RadianceReader, LightPassesGlass) {
  const SceneInput scene = read(
      "void glass pane 0 0 3 0.96 0.96 0.96\npane polygon w 0 0 9 0 0 0 1 0 0 0 1 0\n"
      "pane polygon w 0 0 9 0 0 0 1 0 0 0 1 0\nvoid polygon v 0 0 9 0 0 0 1 0 0 0 1 0\n" +
      kGrey + kTriangle);
  ASSERT_EQ(scene.polygons.size(), 1u);
  EXPECT_EQ(scene.groups, std::vector<std::string>{"wall.1"});
  EXPECT_EQ(scene.materials.size(), 1u);
  expect_words(scene.notes.at(0), {"left out", "1 of void", "2 of glass 'pane' (line 1)"});
}

TEST(RadianceReader, NotesStayShort) {
  std::string text = kGrey + kTriangle;
  for (int i = 0; i < 1000; ++i) text += "!command\nvoid brightfunc b 2 x . 0 0\n";
  for (const std::string& note : notes_of(text)) {
    EXPECT_LT(note.size(), 600u);
    expect_words(note, {"and 988 more"});
  }
}

/// A surface of `grey`, by its type and numbers.
SceneInput surface(const std::string& type, const std::string& numbers) {
  return read(kGrey + "grey " + type + " s 0 0 " + numbers + "\n");
}

/// How far the fronts look outwards, away from a point: each face's area times the sine of its elevation.
double outward_area(const SceneInput& scene, const glm::dvec3& centre) {
  double sum = 0;
  for (const InputPolygon& polygon : scene.polygons)
    sum += glm::dot(area_vector(polygon), glm::normalize(polygon.corners[0] - centre));
  return sum;
}

TEST(RadianceReader, RoundSurfacesKeepTheirArea) {
  // Rounding alone: the corners are placed so that the areas agree.
  const auto expect_area = [](const std::string& type, const std::string& numbers, double area) {
    EXPECT_NEAR(area_of(surface(type, numbers)), area, 1e-12 * area) << type;
  };
  expect_area("sphere", "4 1 2 3 0.5", pi);
  expect_area("bubble", "4 1 2 3 0.5", pi);
  expect_area("cylinder", "7 0 0 0 1 2 2 0.5", 3 * pi);
  expect_area("tube", "7 0 0 0 1 2 2 0.5", 3 * pi);
  expect_area("cone", "8 0 0 0 0 0 4 5 2", 7 * pi * 5);
  expect_area("cup", "8 0 0 0 0 0 4 0 3", 3 * pi * 5);
  expect_area("cone", "8 0 0 0 0 0 4 3 0", 3 * pi * 5);
  expect_area("ring", "8 0 0 0 1 1 1 0 2", 4 * pi);
  expect_area("ring", "8 0 0 0 1 1 1 1 2", 3 * pi);
  expect_area("ring", "8 0 0 0 1 1 1 2 1", 3 * pi);
}

TEST(RadianceReader, FrontsLookWhereTheTypeSays) {
  EXPECT_GT(outward_area(surface("sphere", "4 1 2 3 0.5"), {1, 2, 3}), 3.0);
  EXPECT_LT(outward_area(surface("bubble", "4 1 2 3 0.5"), {1, 2, 3}), -3.0);
  EXPECT_GT(outward_area(surface("cylinder", "7 0 0 -1 0 0 1 1"), {0, 0, 0}), 6.0);
  EXPECT_LT(outward_area(surface("tube", "7 0 0 -1 0 0 1 1"), {0, 0, 0}), -6.0);
  EXPECT_GT(outward_area(surface("cone", "8 0 0 -1 0 0 1 1 0"), {0, 0, -1}), 3.0);
  EXPECT_LT(outward_area(surface("cup", "8 0 0 1 0 0 -1 0 1"), {0, 0, -1}), -3.0);
  for (const char* const radii : {"0 2", "1 2", "2 1"}) {
    const SceneInput ring = surface("ring", std::string("8 0 0 0 0 -3 0 ") + radii);
    for (const InputPolygon& polygon : ring.polygons) EXPECT_LT(area_vector(polygon).y, 0) << radii;
  }
}

// The distances that round_surfaces.hpp states.
TEST(RadianceReader, RoundSurfacesAreNearTheTrueOnes) {
  const SceneInput sphere = surface("sphere", "4 1 2 3 0.5");
  EXPECT_EQ(sphere.polygons.size(), 512u);
  for (const InputPolygon& polygon : sphere.polygons) {
    glm::dvec3 middle(0);
    for (const glm::dvec3& corner : polygon.corners) {
      EXPECT_NEAR(glm::distance(corner, glm::dvec3(1, 2, 3)), 0.5, 0.5 * 0.006);
      middle += corner / static_cast<double>(polygon.corners.size());
    }
    EXPECT_NEAR(glm::distance(middle, glm::dvec3(1, 2, 3)), 0.5, 0.5 * 0.006);
  }
  const SceneInput disk = surface("ring", "8 0 0 0 0 0 1 0 1");
  ASSERT_EQ(disk.polygons.size(), 1u);
  ASSERT_EQ(disk.polygons[0].corners.size(), 32u);
  for (const glm::dvec3& corner : disk.polygons[0].corners) EXPECT_NEAR(glm::length(corner), 1, 0.004);
}

TEST(RadianceReader, APolygonWithASeamHasAHole) {
  const SceneInput scene =
      surface("polygon", "30 0 0 0 3 0 0 3 3 0 0 3 0 0 0 0 1 1 0 1 2 0 2 2 0 2 1 0 1 1 0");
  const Scene patches = to_patches(scene, {});
  double area = 0;
  for (const Patch& patch : patches.patches) area += patch.area;
  EXPECT_NEAR(area, 8, 1e-12);
}

TEST(RadianceReader, TakesStringsInQuotes) {
  EXPECT_EQ(read(kGrey + "grey polygon \"left wall\" 0 0 9 0 0 0 1 0 0 0 1 0\n").groups,
            std::vector<std::string>{"left wall"});
  expect_words(error_of(kGrey + "grey polygon \"left wall 0 0 9\n"), {"a.rad:5:", "in quotes"});
}

TEST(RadianceReader, CountsLinesOfAllEnds) {
  for (const char* const end : {"\n", "\r\n", "\r"})
    expect_words(error_of(std::string("# a") + end + end + "void plastik a" + end), {"a.rad:3:"});
}

struct BadRadiance {
  const char* name;
  std::string text;
  std::vector<std::string> words;
};

class RadianceReaderRejects : public testing::TestWithParam<BadRadiance> {};

TEST_P(RadianceReaderRejects, WithFileAndLine) { expect_words(error_of(GetParam().text), GetParam().words); }

INSTANTIATE_TEST_SUITE_P(
    Radiance, RadianceReaderRejects,
    testing::Values(
        BadRadiance{"Empty", "", {"dir/a.rad:", "holds no surface"}},
        BadRadiance{"Binary", std::string("void\0", 5), {"dir/a.rad:1:", "binary"}},
        BadRadiance{"UnknownType", "void plastik a 0 0 0\n", {"a.rad:1:", "'plastik' is no type"}},
        BadRadiance{"NoType", "# x\nvoid", {"a.rad:2:", "ends before the type"}},
        BadRadiance{"NoIdentifier", "void plastic", {"a.rad:1:", "ends before the identifier"}},
        BadRadiance{
            "FewReals", "void plastic a\n0\n0\n4 1 1 1 0\n", {"a.rad:4:", "plastic 'a' has 4", "needs 5"}},
        BadRadiance{"ManyReals", "void light a 0 0 4 1 1 1 0\n", {"a.rad:1:", "light 'a' has 4", "needs 3"}},
        BadRadiance{"Triples", kGrey + "grey polygon p\n0\n0\n10\n", {"a.rad:8:", "has 10", "3 for each"}},
        BadRadiance{"TwoCorners", kGrey + "grey polygon p\n0\n0\n6\n", {"a.rad:8:", "has 6", "3 to 4096"}},
        BadRadiance{"ManyCorners", kGrey + "grey polygon p 0 0 12291\n", {"has 12291", "3 to 4096"}},
        BadRadiance{
            "EndOfReals", kGrey + "grey polygon p 0 0 9 1 2\n", {"a.rad:5:", "ends within the arguments"}},
        BadRadiance{
            "HugeCount", "void brightfunc b 2147483648 x\n", {"a.rad:1:", "ends before string argument"}},
        BadRadiance{"HugeReals", "void brightfunc b 0 0 99999999999 1\n", {"ends within the arguments"}},
        BadRadiance{"NegativeCount", "void plastic a 0 0 -5\n", {"a.rad:1:", "'-5' is no number of real"}},
        BadRadiance{"WordAsCount", "void plastic a none\n", {"a.rad:1:", "'none' is no number of string"}},
        BadRadiance{"Word", "void plastic a 0 0 5\n1 1 x 0 0\n", {"a.rad:2:", "'x' is not a number"}},
        BadRadiance{"Nan", "void plastic a 0 0 5 nan 1 1 0 0\n", {"a.rad:1:", "'nan' is not a finite"}},
        BadRadiance{"Infinite", "void light a 0 0 3 1 1e999 1\n", {"a.rad:1:", "'1e999' is not a finite"}},
        BadRadiance{"Integer", "void plastic a 0 1 x 0\n", {"a.rad:1:", "integer argument", "'x'"}},
        BadRadiance{
            "Reflectance", "void plastic a 0 0 5 1 1.5 1 0 0\n", {"a.rad:1:", "argument 2 is 1.5", "0..1"}},
        BadRadiance{"Specularity", "void plastic a 0 0 5 1 1 1 2 0\n", {"argument 4 is 2", "0..1"}},
        BadRadiance{"Transmissivity", "void trans a 0 0 7 1 1 1 0 0 -1 0\n", {"argument 6 is -1", "0..1"}},
        BadRadiance{
            "Radiance", "void light a 0 0 3 1 -1 1\n", {"a.rad:1:", "radiance -1 of light 'a'", "negative"}},
        BadRadiance{"HugeRadiance", "void light a 0 0 3 1 1e20 1\n", {"radiance 1e+20", "too large"}},
        BadRadiance{"UnknownModifier",
                    kTriangle,
                    {"a.rad:1:", "polygon 'wall.1'", "unknown modifier 'grey'", "before"}},
        BadRadiance{"LaterModifier", kTriangle + kGrey, {"a.rad:1:", "unknown modifier 'grey'"}},
        BadRadiance{
            "UnknownOfMaterial", "x plastic a 0 0 5 1 1 1 0 0\n", {"a.rad:1:", "unknown modifier 'x'"}},
        BadRadiance{"AliasOfItself", "void alias a a\n", {"a.rad:1:", "alias 'a'", "unknown modifier 'a'"}},
        BadRadiance{"AliasCircle", "void alias a b\nvoid alias b a\n", {"a.rad:1:", "unknown modifier 'b'"}},
        BadRadiance{"AliasEnd", "void alias a", {"a.rad:1:", "what an alias stands for"}},
        BadRadiance{"Mixture", "void mixfunc m 1 a 0 0\n", {"a.rad:1:", "mixfunc 'm' has 1 string"}},
        BadRadiance{"UnknownOfMixture", "void mixfunc m 2 a b 0 0\n", {"a.rad:1:", "unknown modifier 'a'"}},
        BadRadiance{"UnknownOfIllum", "void illum m 1 a 0 3 1 1 1\n", {"a.rad:1:", "unknown modifier 'a'"}},
        BadRadiance{
            "ZeroRadius", kGrey + "grey sphere s 0 0 4 0 0 0 0\n", {"a.rad:5:", "sphere 's'", "radius is 0"}},
        BadRadiance{
            "NegativeRadius", kGrey + "grey sphere s 0 0 4 0 0 0 -1\n", {"radius -1 is negative", "bubble"}},
        BadRadiance{"NoAxis", kGrey + "grey cylinder s 0 0 7 1 2 3 1 2 3 1\n", {"ends are one point"}},
        BadRadiance{"NoCone", kGrey + "grey cone s 0 0 8 0 0 0 0 0 1 0 0\n", {"both radii are 0"}},
        BadRadiance{"NoDirection", kGrey + "grey ring s 0 0 8 0 0 0 0 0 0 0 1\n", {"direction is 0"}},
        BadRadiance{"NoRing", kGrey + "grey ring s 0 0 8 0 0 0 0 0 1 1 1\n", {"both radii are the same"}},
        BadRadiance{
            "FarAway", kGrey + "grey sphere s 0 0 4 1e16 0 0 1\n", {"a.rad:5:", "1e+16 is too large"}}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace fluxel::radiance_reader_test
