#include "scene/readers/obj_reader.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "core/error.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel {
namespace {

using test_messages::expect_words;

using Files = std::map<std::string, std::string>;

constexpr const char* kMaterials = "newmtl white\nKd 0.7 0.6 0.5\nnewmtl lamp\nKd 0 0 0\nKe 17 12 4\n";
constexpr const char* kSquareText = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

SceneInput read(const std::string& obj, const Files& files = {{"dir/m.mtl", kMaterials}}) {
  return read_obj_text("dir/a.obj", obj, [&](const std::filesystem::path& path) {
    const auto found = files.find(path.string());
    return found == files.end() ? std::nullopt : std::optional(found->second);
  });
}

std::string error_of(const std::string& obj, const Files& files = {{"dir/m.mtl", kMaterials}}) {
  try {
    static_cast<void>(read(obj, files));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string error_in_mtl(const std::string& mtl) {
  return error_of("mtllib m.mtl\n" + std::string(kSquareText) + "f 1 2 3\n", {{"dir/m.mtl", mtl}});
}

TEST(ObjReader, ReadsVerticesFacesGroupsAndMaterials) {
  const SceneInput scene = read(
      "mtllib m.mtl\nv 0 0 0\nv 552.8 0 0\nv 0.1 -1e-3 +2.5\nv .5 5. 1E2\n"
      "g floor\nusemtl white\nf 1 2 3 4\no ceiling\nusemtl lamp\nf 1 2 3\ng floor\nf 2 3 4\n");
  EXPECT_EQ(scene.name, "a");
  ASSERT_EQ(scene.polygons.size(), 3u);
  ASSERT_EQ(scene.polygons[0].corners.size(), 4u);
  EXPECT_EQ(scene.polygons[0].corners[1], glm::dvec3(552.8, 0, 0));
  EXPECT_EQ(scene.polygons[0].corners[2], glm::dvec3(0.1, -1e-3, 2.5));
  EXPECT_EQ(scene.polygons[0].corners[3], glm::dvec3(0.5, 5, 100));
  EXPECT_EQ(scene.groups, (std::vector<std::string>{"floor", "ceiling"}));
  EXPECT_EQ(index(scene.polygons[1].group), 1u);
  EXPECT_EQ(index(scene.polygons[2].group), 0u);
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "white");
  EXPECT_DOUBLE_EQ(scene.materials[0].rho.r, 0.7);
  EXPECT_DOUBLE_EQ(scene.materials[0].rho.g, 0.6);
  EXPECT_DOUBLE_EQ(scene.materials[0].rho.b, 0.5);
  EXPECT_EQ(scene.materials[1].Ke, Rgb(17, 12, 4));
  EXPECT_FALSE(scene.materials[1].E.has_value());
  EXPECT_EQ(index(scene.polygons[0].material), 0u);
  EXPECT_EQ(index(scene.polygons[2].material), 1u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(ObjReader, KeepsDoublePrecision) {
  const SceneInput scene = read("v 1000000.0001 0 0\nv 0 0.123456789012 0\nv 0 0 1\nf 1 2 3\n");
  EXPECT_DOUBLE_EQ(scene.polygons[0].corners[0].x, 1000000.0001);
  EXPECT_DOUBLE_EQ(scene.polygons[0].corners[1].y, 0.123456789012);
}

TEST(ObjReader, TakesRelativeForwardAndSlashedIndices) {
  const SceneInput scene =
      read("f 1 2 3\n" + std::string(kSquareText) +
           "f -4 -3 -1\nvt 0 0\nvn 0 0 1\nf 1/1 2/1 4/1\nf 1//1 2//1 4//1\nf 1/1/1 2/-1/-1 4/1/1\n");
  ASSERT_EQ(scene.polygons.size(), 5u);
  EXPECT_EQ(scene.polygons[0].corners[2], glm::dvec3(1, 1, 0));
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_EQ(scene.polygons[i].corners, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << i;
  }
}

TEST(ObjReader, TakesContinuedLinesCrlfTabsAndComments) {
  const SceneInput scene = read(
      "\xEF\xBB\xBF# a comment\r\n\r\n\tv\t0 0 0 # origin\r\nv 1 0 \\\r\n 0\r\nv 1 1 0\r\n  # another\r\n"
      "vn 0 0 nonsense\r\ns off\r\nl 1 2\r\nunknown words\r\nf 1 2 \\\r\n3 # last");
  ASSERT_EQ(scene.polygons.size(), 1u);
  EXPECT_EQ(scene.polygons[0].corners, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
}

TEST(ObjReader, TakesCarriageReturnsAsEndsOfLines) {
  EXPECT_EQ(read("v 0 0 0\rv 1 0 0\rv 1 1 0\r\rg a\rf 1 2 3\r").groups, std::vector<std::string>{"a"});
  expect_words(error_of("v 0 0 0\r\rv x 0 0\r"), {"dir/a.obj:3:"});
}

TEST(ObjReader, KeepsBlanksInNames) {
  const SceneInput scene = read(
      "mtllib my materials.mtl\n" + std::string(kSquareText) + "g left wall\nusemtl Material #25 \nf 1 2 3\n",
      {{"dir/my materials.mtl", "newmtl  Material #25\nKd 1 1 1\n"}});
  EXPECT_EQ(scene.groups, std::vector<std::string>{"left wall"});
  EXPECT_EQ(scene.materials[0].name, "Material #25");
}

TEST(ObjReader, ReadsSeveralMaterialFiles) {
  const SceneInput scene =
      read("mtllib a.mtl b.mtl\nmtllib a.mtl\n" + std::string(kSquareText) + "usemtl b\nf 1 2 3\n",
           {{"dir/a.mtl", "newmtl a\nKd 1 1 1\n"}, {"dir/b.mtl", "newmtl b\nKd 0.25\n"}});
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[index(scene.polygons[0].material)].rho, Rgb(0.25));
}

TEST(ObjReader, FacesWithoutMaterialGetTheDefaultAndANote) {
  const SceneInput scene = read(std::string(kSquareText) + "f 1 2 3\nf 1 3 4\n");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "default");
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.5));
  EXPECT_EQ(scene.groups, std::vector<std::string>{"default"});
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"2 of 2 faces", "no material", "0.5"});
}

TEST(ObjReader, NotesMissingKd) {
  const SceneInput scene = read("mtllib m.mtl\n" + std::string(kSquareText) + "usemtl a\nf 1 2 3\n",
                                {{"dir/m.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\nKe 1 1 1\n"}});
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"dir/m.mtl", "no Kd", "reflectance 0", "b"});
  EXPECT_EQ(scene.materials[1].rho, Rgb(0));
}

TEST(ObjReader, NamesKeysThatAreNotUsedWithTheirCounts) {
  const SceneInput scene = read(
      "mtllib m.mtl\n" + std::string(kSquareText) + "vn 0 0 1\nvt 0 0\ns 1\nl 1 2\nl 2 3\np 1\nf 1 2 3\n",
      {{"dir/m.mtl",
        "newmtl a\nKd 1\nKs 1\nNs 10\nillum 2\nd 1\nnewmtl b\nKd 1\nKs 0\nmap_Bump -bm 2 b.png\nTr 0\n"}});
  ASSERT_GE(scene.notes.size(), 2u);
  EXPECT_EQ(scene.notes[0],
            "dir/m.mtl: not used: Ks (2), Ns (1), illum (1), map_Bump (1); surfaces are diffuse and opaque "
            "unless a scene file says more");
  EXPECT_EQ(scene.notes[1], "dir/a.obj: not used: l (2), p (1); only faces are");
}

TEST(ObjReader, TakesTransparentMaterialsAsOpaque) {
  const SceneInput scene = read("mtllib m.mtl\n" + std::string(kSquareText) + "usemtl a\nf 1 2 3\n",
                                {{"dir/m.mtl",
                                  "newmtl a\nKd 1\nd 0.5\nnewmtl b\nKd 1\nd -halo 0.9\nnewmtl c\nKd 1\nTr "
                                  "0.25\nnewmtl e\nKd 1\nTr 1\nd 1\n"
                                  "newmtl f\nKd 1\nd 1\nTr 1\nnewmtl g\nKd 1\nd x\nmap_d a.png\n"}});
  ASSERT_EQ(scene.notes.size(), 2u);
  EXPECT_EQ(scene.notes[0],
            "dir/m.mtl: d below 1 is not used, opaque unless a scene file says more: material a, b, c");
  expect_words(scene.notes[1], {"not used: d (1), map_d (1);", "opaque"});
}

TEST(ObjReader, ReadsAFaceOfManyCorners) {
  std::string obj, face = "f";
  for (int i = 1; i <= 1000; ++i) {
    obj += "v " + std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
    face += " " + std::to_string(i);
  }
  EXPECT_EQ(read(obj + face + "\n").polygons[0].corners.size(), 1000u);
}

struct BadObj {
  const char* name;
  std::string text;
  std::vector<std::string> words;
};

class ObjReaderRejects : public testing::TestWithParam<BadObj> {};

TEST_P(ObjReaderRejects, WithFileAndLine) { expect_words(error_of(GetParam().text), GetParam().words); }

const std::string kFour = kSquareText;

INSTANTIATE_TEST_SUITE_P(
    Obj, ObjReaderRejects,
    testing::Values(
        BadObj{"Nan", "v 0 0 0\nv nan 0 0\n", {"dir/a.obj:2:", "vertex", "'nan'", "not a finite"}},
        BadObj{"Infinite", "v 0 -inf 0\n", {"dir/a.obj:1:", "'-inf'", "not a finite"}},
        BadObj{"Overflow", "v 0 0 1e999\n", {"dir/a.obj:1:", "'1e999'", "not a finite"}},
        BadObj{"TooLarge", "v 0 0 1e30\n", {"dir/a.obj:1:", "'1e30'", "too large"}},
        BadObj{"TwoPoints", "v 1.2.3 0 0\n", {"dir/a.obj:1:", "'1.2.3'", "not a number"}},
        BadObj{"Word", "\n\nv 0 zero 0\n", {"dir/a.obj:3:", "'zero'", "not a number"}},
        BadObj{"CommaDecimals", "v 0,5 0 0\n", {"dir/a.obj:1:", "'0,5'", "not a number"}},
        BadObj{"TwoCoordinates", "v 1 2\n", {"dir/a.obj:1:", "vertex", "too few"}},
        BadObj{"CommentedCoordinate", "v 1 2 # 3\n", {"dir/a.obj:1:", "vertex", "too few"}},
        BadObj{"TwoCorners", kFour + "f 1 2\n", {"dir/a.obj:5:", "at least 3 corners", "has 2"}},
        BadObj{"NoCorners", kFour + "f\n", {"dir/a.obj:5:", "at least 3 corners", "has 0"}},
        BadObj{"IndexZero", kFour + "f 0 1 2\n", {"dir/a.obj:5:", "'0'", "is 0", "count from 1"}},
        BadObj{"IndexAbove", kFour + "f 1 2 5\n", {"dir/a.obj:5:", "'5'", "out of range", "4 vertices"}},
        BadObj{"IndexBelow", kFour + "f 1 2 -5\n", {"dir/a.obj:5:", "'-5'", "out of range", "4 vertices"}},
        BadObj{"IndexHuge",
               kFour + "f 1 2 99999999999999999999\n",
               {"dir/a.obj:5:", "99999999999999999999", "not a whole number"}},
        BadObj{"IndexReal", kFour + "f 1 2 3.5\n", {"dir/a.obj:5:", "'3.5'", "not a whole number"}},
        BadObj{"IndexWord", kFour + "f 1 2 x\n", {"dir/a.obj:5:", "'x'", "not a whole number"}},
        BadObj{"IndexSlashWord", kFour + "f 1/a 2 3\n", {"dir/a.obj:5:", "'1/a'", "not a whole number"}},
        BadObj{"IndexSlashEnd", kFour + "f 1/1/ 2 3\n", {"dir/a.obj:5:", "'1/1/'", "not a whole number"}},
        BadObj{"IndexFourParts", kFour + "f 1/1/1/1 2 3\n", {"dir/a.obj:5:", "not a whole number"}},
        BadObj{"LineAfterContinued", "v 0 0 \\\n0\nv x 0 0\n", {"dir/a.obj:3:", "'x'"}},
        BadObj{"MissingLibrary", "\nmtllib gone.mtl\n", {"dir/a.obj:2:", "cannot find", "dir/gone.mtl"}},
        BadObj{"MissingSecondLibrary",
               "mtllib m.mtl gone.mtl\n",
               {"dir/a.obj:1:", "cannot find", "dir/gone.mtl"}},
        BadObj{"LibraryWithoutName", "mtllib\n", {"dir/a.obj:1:", "mtllib names no file"}},
        BadObj{"UnknownMaterial",
               "mtllib m.mtl\n" + kFour + "usemtl wite\nf 1 2 3\n",
               {"dir/a.obj:6:", "unknown material 'wite'", "lamp", "white"}},
        BadObj{"NoLibrary", kFour + "usemtl white\nf 1 2 3\n", {"dir/a.obj:5:", "'white'", "mtllib"}},
        BadObj{"MaterialWithoutName", "usemtl \n", {"dir/a.obj:1:", "usemtl names no material"}},
        BadObj{"NoFace", kFour, {"dir/a.obj:", "holds no face"}},
        BadObj{"Empty", "", {"dir/a.obj:", "holds no face"}},
        BadObj{"Binary", std::string("v 0 0 0\nv 1\0 0 0\n", 17), {"dir/a.obj:2:", "binary"}},
        BadObj{"LongLine", "\n# " + std::string(2000000, 'x'), {"dir/a.obj:2:", "too long"}},
        BadObj{"ManyCorners",
               [] {
                 std::string face = kFour + "f";
                 for (int i = 0; i < 5000; ++i) face += " 1";
                 return face;
               }(),
               {"dir/a.obj:5:", "more than 4096 corners"}}),
    [](const auto& instance) { return instance.param.name; });

class MtlRejects : public testing::TestWithParam<BadObj> {};

TEST_P(MtlRejects, WithFileAndLine) { expect_words(error_in_mtl(GetParam().text), GetParam().words); }

INSTANTIATE_TEST_SUITE_P(
    Mtl, MtlRejects,
    testing::Values(
        BadObj{"ReflectanceAbove",
               "newmtl a\nKd 0.5 1.01 0\n",
               {"dir/m.mtl:2:", "reflectance", "1.01", "'a'", "0..1"}},
        BadObj{
            "ReflectanceBelow", "newmtl a\nKd -0.1 0 0\n", {"dir/m.mtl:2:", "reflectance", "-0.1", "0..1"}},
        BadObj{"ReflectanceNan", "newmtl a\nKd nan 0 0\n", {"dir/m.mtl:2:", "Kd", "'nan'", "not a finite"}},
        BadObj{"ReflectanceWord", "newmtl a\nKd white\n", {"dir/m.mtl:2:", "Kd", "'white'", "not a number"}},
        BadObj{"ReflectanceSpectral", "newmtl a\nKd spectral a.rfl\n", {"dir/m.mtl:2:", "'spectral'"}},
        BadObj{"TwoChannels", "newmtl a\nKd 0.5 0.5\n", {"dir/m.mtl:2:", "Kd", "too few"}},
        BadObj{"NoChannel", "newmtl a\nKe\n", {"dir/m.mtl:2:", "Ke", "too few"}},
        BadObj{"EmissionNegative",
               "newmtl a\nKe 1 -2 1\n",
               {"dir/m.mtl:2:", "emission", "-2", "'a'", "negative"}},
        BadObj{"EmissionInfinite", "newmtl a\nKe 1 inf 1\n", {"dir/m.mtl:2:", "emission", "not a finite"}},
        BadObj{"EmissionHuge", "newmtl a\nKe 1e300 1 1\n", {"dir/m.mtl:2:", "emission", "too large"}},
        BadObj{"NoNewmtl", "# x\nKd 0 0 0\n", {"dir/m.mtl:2:", "Kd stands before any newmtl"}},
        BadObj{"Unnamed", "newmtl\nKd 0 0 0\n", {"dir/m.mtl:1:", "newmtl names no material"}},
        BadObj{"Twice", "newmtl a\nKd 0 0 0\nnewmtl a\n", {"dir/m.mtl:3:", "'a'", "twice", "dir/m.mtl:1"}},
        BadObj{"Binary", std::string("newmtl a\n\x01"), {"dir/m.mtl:2:", "binary"}}),
    [](const auto& instance) { return instance.param.name; });

TEST(ObjReader, CutsLongNamesAndListsInMessages) {
  std::string mtl;
  for (int i = 0; i < 40; ++i) mtl += "newmtl m" + std::to_string(i) + "\nKd 0\n";
  const std::string message =
      error_of("mtllib m.mtl\nusemtl " + std::string(5000, 'x') + "\n", {{"dir/m.mtl", mtl}});
  EXPECT_LT(message.size(), 300u);
  expect_words(message, {"dir/a.obj:2:", "and 28 more"});
}

TEST(ObjReader, ReadsHeatOfMaterials) {
  const SceneInput scene =
      read("mtllib m.mtl\n" + std::string(kSquareText) + "f 1 2 3\n",
           {{"dir/m.mtl",
             "newmtl hot\nKd 0.5\ntemperature 1273.15 # kelvin\nemissivity 0.8\nnewmtl brick\nKd 0\n"
             "\theat_flux -1.5e2\nnewmtl plain\nKd 0.1\nNs 10\nnewmtl last\nKd 0\nemissivity 1\n"
             "newmtl case\nconvection_coefficient 12.5\nair_temperature 290\n"}});
  ASSERT_EQ(scene.materials.size(), 6u);  // and the default of the face
  EXPECT_EQ(scene.materials[0].heat, (InputHeat{0.8, 1273.15, {}}));
  EXPECT_EQ(scene.materials[1].heat, (InputHeat{{}, {}, -150.0}));
  EXPECT_EQ(scene.materials[2].heat, InputHeat{});
  EXPECT_EQ(scene.materials[3].heat, (InputHeat{1.0, {}, {}}));
  EXPECT_EQ(scene.materials[4].heat, (InputHeat{{}, {}, {}, 12.5, 290.0}));
}

TEST(ObjReader, RefusesBadHeat) {
  const std::string start = "newmtl a\nKd 0.5\n";
  expect_words(error_in_mtl("emissivity 0.5\n"), {"dir/m.mtl:1:", "emissivity stands before any newmtl"});
  expect_words(error_in_mtl(start + "emissivity\n"), {"dir/m.mtl:3:", "emissivity", "too few numbers"});
  expect_words(error_in_mtl(start + "emissivity high\n"), {":3:", "'high' is not a number"});
  expect_words(error_in_mtl(start + "temperature nan\n"), {":3:", "not a finite number"});
  expect_words(error_in_mtl(start + "heat_flux 1e999\n"), {":3:", "not a finite number"});
  expect_words(error_in_mtl(start + "emissivity 0\n"), {":3:", "emissivity 0 of material 'a'", "1e-6..1"});
  expect_words(error_in_mtl(start + "emissivity 1.01\n"), {":3:", "emissivity 1.01", "1e-6..1"});
  expect_words(error_in_mtl(start + "temperature -1\n"), {":3:", "temperature -1", "below 0 kelvin"});
  expect_words(error_in_mtl(start + "temperature 2e5\n"), {":3:", "too large", "100000 kelvin"});
  expect_words(error_in_mtl(start + "heat_flux -2e15\n"), {":3:", "heat_flux", "too large"});
  expect_words(error_in_mtl(start + "emissivity 0.5\nemissivity 0.5\n"), {":4:", "given twice"});
  expect_words(error_in_mtl(start + "temperature 300\nheat_flux 0\n"), {":4:", "heat_flux 0", "either"});
  expect_words(error_in_mtl(start + "heat_flux 0\nemissivity 1\ntemperature 300\n"), {":5:", "either"});
}

}  // namespace
}  // namespace fluxel
