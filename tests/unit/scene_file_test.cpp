#include "scene/readers/scene_file.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "tests/unit/messages.hpp"
#include "tests/unit/scene_text.hpp"

namespace fluxel {
namespace {

using test_messages::expect_words;
using test_scene_text::error_of;
using test_scene_text::Files;
using test_scene_text::kBox;
using test_scene_text::kBoxMaterials;
using test_scene_text::kFiles;
using test_scene_text::kGeometry;
using test_scene_text::read;

std::string option(const SceneInput& scene, const std::string& name) {
  for (const InputOption& option : scene.options) {
    if (option.name == name) return option.value + " @" + std::to_string(option.line);
  }
  return "not set";
}

TEST(SceneFile, ReadsGeometryWithScaleAndShift) {
  const SceneInput scene = read("title = \"A box\"\nabout = \"why\"\n" + kGeometry +
                                "metres_per_unit = 0.5\ntranslate = [10, 0, -1.5]\n");
  EXPECT_EQ(scene.name, "A box");
  EXPECT_EQ(scene.file, "dir/scene.toml");
  ASSERT_EQ(scene.polygons.size(), 2u);
  EXPECT_EQ(scene.polygons[0].corners[2], glm::dvec3(10.5, 0.5, -1.5));
  ASSERT_EQ(scene.geometry.size(), 1u);
  EXPECT_EQ(scene.geometry[0].file, "dir/box.obj");
  EXPECT_EQ(scene.geometry[0].metres_per_unit, 0.5);
  EXPECT_EQ(scene.geometry[0].translate, glm::dvec3(10, 0, -1.5));
  EXPECT_EQ(scene.groups, (std::vector<std::string>{"floor", "lamp"}));
  EXPECT_TRUE(scene.options.empty());
  EXPECT_TRUE(scene.notes.empty());
}

TEST(SceneFile, TakesItsNameFromTheFileWithoutATitle) { EXPECT_EQ(read(kGeometry).name, "scene"); }

TEST(SceneFile, OverridesMaterials) {
  const SceneInput scene = read(kGeometry +
                                "[materials.white]\nrho = [0.7, 0.6, 0]\nsides = \"two\"\n"
                                "[materials.light]\nE = 2.5\nrho = 1\n");
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.7, 0.6, 0));
  EXPECT_EQ(scene.materials[0].sides, Sides::two);
  EXPECT_FALSE(scene.materials[0].E.has_value());
  EXPECT_EQ(scene.materials[1].rho, Rgb(1));
  EXPECT_EQ(scene.materials[1].E, Rgb(2.5));
  EXPECT_EQ(scene.materials[1].Ke, Rgb(1, 2, 3));
  EXPECT_FALSE(scene.materials[1].sides.has_value());
}

TEST(SceneFile, ReadsReceivers) {
  const SceneInput scene = read(kGeometry +
                                "[[receivers]]\nname = \"desk_1.b-c\"\norigin = [1, 2, 3.5]\n"
                                "u = [0, 2, 0]\nv = [0.5, 0, 1]\ncells = [8, 4]\n"
                                "[[receivers]]\nname = \"wall\"\norigin = [0, 0, 0]\n"
                                "u = [1e-6, 0, 0]\nv = [0, 1e-6, 0]\ncells = [1, 65536]\n");
  ASSERT_EQ(scene.receivers.size(), 2u);
  const Receiver& desk = scene.receivers[0];
  EXPECT_EQ(desk.name, "desk_1.b-c");
  EXPECT_EQ(desk.origin, glm::dvec3(1, 2, 3.5));
  EXPECT_EQ(desk.u, glm::dvec3(0, 2, 0));
  EXPECT_EQ(desk.v, glm::dvec3(0.5, 0, 1));
  EXPECT_EQ(desk.columns, 8);
  EXPECT_EQ(desk.rows, 4);
  EXPECT_EQ(scene.receivers[1].name, "wall");
  EXPECT_EQ(scene.receivers[1].rows, 65536);
  EXPECT_TRUE(read(kGeometry).receivers.empty());
}

/// What is said of a receiver in which `from` is replaced by `to`.
std::string error_of_receiver(const std::string& from, const std::string& to) {
  std::string receiver =
      "[[receivers]]\nname = \"in\"\norigin = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 1, 0]\ncells = [2, 3]\n";
  const std::size_t at = receiver.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  receiver.replace(at, from.size(), to);
  return error_of(kGeometry + receiver);
}

TEST(SceneFile, RefusesBadReceivers) {
  expect_words(error_of("receivers = 3\n" + kGeometry), {":1:", "[[receivers]]"});
  expect_words(error_of_receiver("[[receivers]]", "[receivers]"), {":3:", "[[receivers]]"});
  expect_words(error_of("receivers = [3]\n" + kGeometry), {":1:", "[[receivers]] must be a table"});
  for (const std::string key :
       {"name = \"in\"", "origin = [0, 0, 0]", "u = [1, 0, 0]", "v = [0, 1, 0]", "cells = [2, 3]"}) {
    expect_words(error_of_receiver(key + "\n", ""), {":3:", "lacks " + key.substr(0, key.find(' '))});
  }
  expect_words(error_of_receiver("cells", "cell = 1\ncells"), {":8:", "'cell'", "cells"});
  for (const std::string name : {"\"\"", "\"a/b\"", "\"a b\"", "\"\u00e9\""})
    expect_words(error_of_receiver("\"in\"", name), {":4:", "file's name"});
  expect_words(error_of_receiver("\"in\"", "3"), {":4:", "text"});
  expect_words(error_of_receiver("cells = [2, 3]\n",
                                 "cells = [2, 3]\n[[receivers]]\nname = \"in\"\norigin = [0, 0, 0]\n"
                                 "u = [1, 0, 0]\nv = [0, 1, 0]\ncells = [1, 1]\n"),
               {":10:", "a second receiver 'in'"});
  expect_words(error_of_receiver("v = [0, 1, 0]", "v = [-2, 0, 0]"), {":3:", "'in' has no area"});
  expect_words(error_of_receiver("v = [0, 1, 0]", "v = [0, 0, 0]"), {":3:", "'in' has no area"});
  expect_words(error_of_receiver("v = [0, 1, 0]", "v = [0, 1, nan]"), {":7:", "v", "finite"});
  expect_words(error_of_receiver("[0, 0, 0]", "[0, 0]"), {":5:", "origin", "array of 3"});
  for (const std::string cells : {"[0, 3]", "[2, 65537]", "[2.5, 1]", "[2, \"3\"]"})
    expect_words(error_of_receiver("[2, 3]", cells), {":8:", "cells", "whole numbers from 1 to 65536"});
  expect_words(error_of_receiver("[2, 3]", "[2]"), {":8:", "cells", "array of 2"});
}

TEST(SceneFile, ReadsTheCamera) {
  const InputCamera camera = read(kGeometry +
                                  "[camera]\n"
                                  "eye = [278, 273.25, -8e2]\n"
                                  "look_at = [0.1, 0, 0]\n"
                                  "up = [0, 1, 0]\n"
                                  "fov = 39.3\n"
                                  "resolution = [256, 128]\n")
                                 .cameras.at(0);
  EXPECT_FALSE(camera.name);
  ASSERT_TRUE(camera.eye && camera.look_at && camera.up && camera.fov && camera.resolution);
  EXPECT_EQ(camera.eye->value, glm::dvec3(278, 273.25, -800));
  EXPECT_EQ(camera.look_at->value, glm::dvec3(0.1, 0, 0));
  EXPECT_EQ(camera.up->value, glm::dvec3(0, 1, 0));
  EXPECT_EQ(camera.fov->value, 39.3);
  EXPECT_EQ(camera.resolution->value, glm::ivec2(256, 128));
  EXPECT_EQ(camera.line_of("eye"), 4u);
  EXPECT_EQ(camera.line_of("look-at"), 5u);
  EXPECT_EQ(camera.line_of("up"), 6u);
  EXPECT_EQ(camera.line_of("fov"), 7u);
  EXPECT_EQ(camera.line_of("resolution"), 8u);
  EXPECT_EQ(camera.line_of("sides"), std::nullopt);
}

TEST(SceneFile, ACameraMayBeGivenInPart) {
  const InputCamera camera =
      read(kGeometry + "[camera]\neye = [0.1234567890123456, 1e300, -0.30000000000000004]\n").cameras.at(0);
  ASSERT_TRUE(camera.eye.has_value());
  EXPECT_EQ(camera.eye->value, glm::dvec3(0.1234567890123456, 1e300, -0.30000000000000004));
  EXPECT_FALSE(camera.look_at || camera.up || camera.fov || camera.resolution);
  EXPECT_EQ(camera.line_of("up"), std::nullopt);
}

TEST(SceneFile, CamerasHaveNames) {
  const std::vector<InputCamera> cameras = read(kGeometry +
                                                "[[camera]]\n"
                                                "name = \"the desk\"\n"
                                                "eye = [1, 2, 3]\n"
                                                "[[camera]]\n"
                                                "fov = 30\n"
                                                "name = \"door\"\n")
                                               .cameras;
  ASSERT_EQ(cameras.size(), 2u);
  ASSERT_TRUE(cameras[0].name && cameras[1].name);
  EXPECT_EQ(cameras[0].name->value, "the desk");
  EXPECT_EQ(cameras[1].name->value, "door");
  EXPECT_EQ(cameras[1].name->line, 8u);
  EXPECT_TRUE(cameras[0].eye && !cameras[0].fov);
  EXPECT_TRUE(cameras[1].fov && !cameras[1].eye);
}

TEST(SceneFile, ASingleCameraMayHaveAName) {
  EXPECT_EQ(read(kGeometry + "[camera]\nname = \"door\"\n").cameras.at(0).name->value, "door");
  EXPECT_TRUE(read(kGeometry).cameras.empty());
}

TEST(SceneFile, OptionsBecomeTexts) {
  const SceneInput scene = read(kGeometry +
                                "[options]\n"
                                "sides = \"one\"\n"
                                "max-edge = 0.1\n"
                                "no-cut = true\n"
                                "quiet = false\n"
                                "max-iterations = 50\n"
                                "tolerance = 1e-7\n"
                                "eye = \"1,2,3\"\n");
  EXPECT_EQ(option(scene, "sides"), "one @4");
  EXPECT_EQ(option(scene, "max-edge"), "0.1 @5");
  EXPECT_EQ(option(scene, "no-cut"), "true @6");
  EXPECT_EQ(option(scene, "quiet"), "false @7");
  EXPECT_EQ(option(scene, "max-iterations"), "50 @8");
  EXPECT_EQ(option(scene, "tolerance"), "1e-07 @9");
  EXPECT_EQ(option(scene, "eye"), "1,2,3 @10");
  EXPECT_EQ(scene.options.size(), 7u);
}

TEST(SceneFile, SeveralFilesShareGroupsAndEqualMaterials) {
  Files files = kFiles;
  files["dir/other.obj"] =
      "mtllib other.mtl\nv 0 0 0\nv 0 0 1\nv 0 1 0\ng lamp\nusemtl light\nf 1 2 3\ng new\nusemtl red\nf 1 2 "
      "3\n";
  files["dir/other.mtl"] = "newmtl red\nKd 1 0 0\nnewmtl light\nKd 0 0 0\nKe 1 2 3\n";
  const SceneInput scene = read(kGeometry + "[[geometry]]\nfile = \"other.obj\"\n", files);
  EXPECT_EQ(scene.groups, (std::vector<std::string>{"floor", "lamp", "new"}));
  ASSERT_EQ(scene.materials.size(), 3u);
  ASSERT_EQ(scene.polygons.size(), 4u);
  EXPECT_EQ(scene.materials[index(scene.polygons[2].material)].name, "light");
  EXPECT_EQ(scene.groups[index(scene.polygons[2].group)], "lamp");
  EXPECT_EQ(scene.materials[index(scene.polygons[3].material)].name, "red");
  EXPECT_EQ(scene.groups[index(scene.polygons[3].group)], "new");
}

TEST(SceneFile, MaterialsThatDifferBetweenFilesAreAnError) {
  Files files = kFiles;
  files["dir/other.obj"] = "mtllib other.mtl\nv 0 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 3\n";
  files["dir/other.mtl"] = "newmtl white\nKd 0.5 0.5 0.6\n";
  expect_words(error_of(kGeometry + "[[geometry]]\nfile = \"other.obj\"\n", files),
               {"dir/scene.toml", "'white'", "dir/box.obj", "dir/other.obj"});
}

TEST(SceneFile, ExtensionsOfGeometryMayBeInCapitals) {
  Files files = kFiles;
  files["dir/BOX.OBJ"] = kBox;
  EXPECT_EQ(read("[[geometry]]\nfile = \"BOX.OBJ\"\n", files).polygons.size(), 2u);
}

TEST(SceneFile, ErrorsOfTheGeometryNameItsOwnFileAndLine) {
  Files files = kFiles;
  files["dir/box.obj"] = "v 0 0 0\nv 1 oops 0\n";
  expect_words(error_of(kGeometry, files), {"dir/box.obj:2:", "'oops'"});
}

struct BadScene {
  const char* name;
  std::string text;
  std::vector<std::string> words;
};

class SceneFileRejects : public testing::TestWithParam<BadScene> {};

TEST_P(SceneFileRejects, WithFileAndLine) { expect_words(error_of(GetParam().text), GetParam().words); }

BadScene bad(const char* name, const std::string& text, std::vector<std::string> words) {
  words.insert(words.begin(), "dir/scene.toml:");
  return {name, text, std::move(words)};
}

/// The text follows the geometry, so that its first line is line 3.
BadScene bad_after(const char* name, const std::string& text, std::vector<std::string> words) {
  return bad(name, kGeometry + text, std::move(words));
}

INSTANTIATE_TEST_SUITE_P(
    Toml, SceneFileRejects,
    testing::Values(
        bad("Empty", "", {"no geometry", "[[geometry]]"}),
        bad("NoGeometry", "geometry = []\n", {"toml:1:", "no geometry"}),
        bad("GeometryIsATable", "[geometry]\nfile = \"box.obj\"\n", {"toml:1:", "[[geometry]]"}),
        bad("GeometryOfNumbers", "geometry = [1]\n", {"toml:1:", "must be a table"}),
        bad("GeometryWithoutFile", "\n[[geometry]]\n", {"toml:2:", "no file"}),
        bad("GeometryMissing", "[[geometry]]\nfile = \"gone.obj\"\n",
            {"toml:2:", "cannot find", "dir/gone.obj"}),
        bad("GeometryExtension", "[[geometry]]\nfile = \"a.xyz\"\n", {"toml:2:", "dir/a.xyz", ".obj"}),
        bad("GeometryIsASceneFile", "[[geometry]]\nfile = \"a.toml\"\n",
            {"toml:2:", "dir/a.toml", "known: .obj"}),
        bad("FileIsANumber", "[[geometry]]\nfile = 3\n", {"toml:2:", "file must be a text"}),
        bad("Syntax", "title = \"x\"\n[[geometry]\n", {"toml:2:", "TOML"}),
        bad("DuplicateKey", "title = \"x\"\ntitle = \"y\"\n", {"toml:2:", "TOML"}),
        bad("TitleIsANumber", "title = 3\n" + kGeometry, {"toml:1:", "title must be a text"}),
        bad("AboutIsANumber", "about = 3\n" + kGeometry, {"toml:1:", "about must be a text"}),
        bad("UnknownKey", "\ncolour = 1\n" + kGeometry,
            {"toml:2:", "unknown key 'colour'", "title", "geometry"}),
        bad_after("UnknownTable", "[sky]\n", {"toml:3:", "unknown key 'sky'", "camera"}),
        bad_after("UnknownGeometryKey", "scales = 2\n",
                  {"toml:3:", "unknown key 'scales'", "did you mean 'scale'?"}),
        bad_after("ScaleZero", "metres_per_unit = 0\n", {"toml:3:", "metres_per_unit", "greater than 0"}),
        bad_after("ScaleNegative", "metres_per_unit = -1.0\n",
                  {"toml:3:", "metres_per_unit", "greater than 0"}),
        bad_after("ScaleNan", "metres_per_unit = nan\n", {"toml:3:", "metres_per_unit", "finite"}),
        bad_after("ScaleText", "metres_per_unit = \"1\"\n", {"toml:3:", "metres_per_unit", "number"}),
        bad_after("TranslateLength", "translate = [0, 1]\n", {"toml:3:", "translate", "array of 3"}),
        bad_after("TranslateNumber", "translate = 1\n", {"toml:3:", "translate", "array of 3"}),
        bad_after("TranslateInfinite", "translate = [0, 1, inf]\n", {"toml:3:", "translate", "finite"}),
        bad_after("UnknownMaterial", "[materials.wite]\nrho = 1\n",
                  {"toml:3:", "'wite'", "did you mean 'white'? Known: white, light"}),
        bad_after("MaterialsIsANumber", "[options]\n[materials]\nwhite = 1\n",
                  {"toml:5:", "must be a table"}),
        bad_after("UnknownMaterialKey", "[materials.white]\nKd = 1\n", {"toml:4:", "'Kd'", "rho, E, sides"}),
        bad_after("RhoAbove", "[materials.white]\nrho = [0.5, 0.5, 1.5]\n",
                  {"toml:4:", "rho", "outside 0..1"}),
        bad_after("RhoBelow", "[materials.white]\nrho = -0.5\n", {"toml:4:", "rho", "outside 0..1"}),
        bad_after("RhoNan", "[materials.white]\nrho = nan\n", {"toml:4:", "rho", "finite"}),
        bad_after("RhoLength", "[materials.white]\nrho = [1, 1]\n", {"toml:4:", "rho", "array of 3"}),
        bad_after("ExitanceNegative", "[materials.light]\nE = [1, -1, 1]\n", {"toml:4:", "E", "negative"}),
        bad_after("ExitanceInfinite", "[materials.light]\nE = inf\n", {"toml:4:", "E", "finite"}),
        bad_after("SidesWord", "[materials.light]\nsides = \"both\"\n", {"toml:4:", "'both'", "one or two"}),
        bad_after("SidesNumber", "[materials.light]\nsides = 2\n", {"toml:4:", "sides", "text"}),
        bad_after("UnknownCameraKey", "[camera]\nlookat = [0, 0, 0]\n",
                  {"toml:4:", "'lookat'", "did you mean 'look_at'?"}),
        bad("CameraIsANumber", "camera = 3\n" + kGeometry, {"toml:1:", "[camera] must be a table"}),
        bad_after("CameraWithoutName", "[[camera]]\nname = \"a\"\n[[camera]]\nfov = 3\n",
                  {"toml:5:", "[[camera]] lacks name", "[camera]"}),
        bad_after("CameraNameEmpty", "[camera]\nname = \"\"\n", {"toml:4:", "name is empty"}),
        bad_after("CameraNameIsANumber", "[camera]\nname = 3\n", {"toml:4:", "name", "text"}),
        bad_after("CameraTwice", "[[camera]]\nname = \"a\"\n[[camera]]\nname = \"a\"\n",
                  {"toml:6:", "a second camera 'a'", "line 4"}),
        bad_after("UnknownKeyOfCameras", "[[camera]]\nlookat = [0, 0, 0]\n",
                  {"toml:4:", "in [[camera]]", "look_at"}),
        bad_after("OptionTwiceOfCameras",
                  "[[camera]]\nname = \"a\"\n[[camera]]\nname = \"b\"\nfov = 3\n[options]\nfov = 4\n",
                  {"toml:9:", "'fov'", "twice", "line 7"}),
        bad_after("EyeText", "[camera]\neye = \"0,0,0\"\n", {"toml:4:", "eye", "array of 3"}),
        bad_after("EyeNan", "[camera]\neye = [0, nan, 0]\n", {"toml:4:", "eye", "finite"}),
        bad_after("FovText", "[camera]\nfov = \"wide\"\n", {"toml:4:", "fov", "number"}),
        bad_after("ResolutionReal", "[camera]\nresolution = [1.5, 2]\n", {"toml:4:", "resolution", "whole"}),
        bad_after("ResolutionZero", "[camera]\nresolution = [0, 2]\n", {"toml:4:", "resolution", "above 0"}),
        bad_after("ResolutionHuge", "[camera]\nresolution = [70000, 2]\n",
                  {"toml:4:", "resolution", "70000", "65536 pixels a side"}),
        bad_after("ResolutionLength", "[camera]\nresolution = [2]\n",
                  {"toml:4:", "resolution", "array of 2"}),
        bad_after("OptionArray", "[options]\neye = [1, 2, 3]\n", {"toml:4:", "'eye'", "text, a number"}),
        bad_after("OptionNan", "[options]\nmax-edge = nan\n", {"toml:4:", "'max-edge'", "finite"}),
        bad_after("OptionTwice", "[camera]\nfov = 3\n[options]\nfov = 4\n",
                  {"toml:6:", "'fov'", "twice", "line 4"})),
    [](const auto& instance) { return instance.param.name; });

class SceneFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) /
             ("fluxel_scene_file_test_" +
              std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }

  [[nodiscard]] std::string error_of_file(const std::string& name) const {
    try {
      static_cast<void>(read_scene_input(folder / name));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder;
};

TEST_F(SceneFolder, ReadsByExtension) {
  write("box.mtl", kBoxMaterials);
  write("box.obj", kBox);
  write("scene.toml", kGeometry);
  EXPECT_EQ(read_scene_input(folder / "box.obj").name, "box");
  EXPECT_EQ(read_scene_input(folder / "scene.toml").polygons.size(), 2u);
  EXPECT_EQ(read_scene_input(folder / "scene.toml").files,
            (std::vector{folder / "scene.toml", folder / "box.obj", folder / "box.mtl"}));
  std::filesystem::rename(folder / "box.obj", folder / "BOX.OBJ");
  EXPECT_EQ(read_scene_input(folder / "BOX.OBJ").polygons.size(), 2u);
}

TEST_F(SceneFolder, JoinsAndOverridesMaterialsOfSeveralFormats) {
  write("a.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid\n");
  write("b.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 188 188 64\n");
  write("c.rad", "void light lamp 0 0 3 1 1 1\nlamp ring disk 0 0 8 0 0 1 0 0 -1 0 1\n");
  write("scene.toml",
        "[[geometry]]\nfile = \"a.stl\"\n[[geometry]]\nfile = \"b.ply\"\n[[geometry]]\nfile = \"c.rad\"\n"
        "[materials.default]\nrho = 0.25\n[materials.\"colour 188 188 64\"]\nrho = 0.75\n"
        "[materials.lamp]\nE = 9\n");
  const SceneInput scene = read_scene_input(folder / "scene.toml");
  EXPECT_EQ(scene.polygons.size(), 3u);
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.25));
  EXPECT_EQ(scene.materials[1].rho, Rgb(0.75));
  EXPECT_EQ(scene.materials[2].E, Rgb(9));
}

TEST_F(SceneFolder, GeometryAloneMayHaveAUnit) {
  write("box.mtl", kBoxMaterials);
  write("box.obj", kBox);
  write("scene.toml", kGeometry);
  const SceneInput metres = read_scene_input(folder / "box.obj");
  EXPECT_FALSE(metres.geometry.at(0).unit_given);
  EXPECT_EQ(metres.polygons.at(0).corners[2], glm::dvec3(1, 1, 0));
  const SceneInput halves = read_scene_input(folder / "box.obj", 0.5);
  EXPECT_EQ(halves.polygons.at(0).corners[2], glm::dvec3(0.5, 0.5, 0));
  ASSERT_EQ(halves.geometry.size(), 1u);
  EXPECT_EQ(halves.geometry[0].metres_per_unit, 0.5);
  EXPECT_EQ(halves.geometry[0].file, folder / "box.obj");
  EXPECT_TRUE(halves.geometry[0].unit_given);
  try {
    static_cast<void>(read_scene_input(folder / "scene.toml", 0.5));
    ADD_FAILURE();
  } catch (const InputError& error) {
    expect_words(error.what(), {"scene.toml: --metres-per-unit", "metres_per_unit", "[[geometry]]"});
  }
}

TEST_F(SceneFolder, RejectsWhatCannotBeRead) {
  write("scene.xyz", "solid");
  write("lonely.obj", "# nothing\nmtllib gone.mtl\n");
  std::filesystem::create_directory(folder / "folder.obj");
  expect_words(error_of_file("gone.obj"), {"gone.obj", "no such file"});
  expect_words(error_of_file("scene.xyz"), {"scene.xyz", ".toml", ".obj"});
  expect_words(error_of_file("folder.obj"), {"folder.obj", "folder, not a file"});
  expect_words(error_of_file("lonely.obj"), {"lonely.obj:2:", (folder / "gone.mtl").string()});
}

}  // namespace
}  // namespace fluxel
