#include "scene/readers/obj_textures.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/error.hpp"
#include "scene/readers/obj_reader.hpp"
#include "scene/readers/scene_file.hpp"
#include "tests/unit/encoded_images.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::obj_textures_test {
namespace {

using test_images::jpeg_of;
using test_images::png_of;
using test_images::Samples;
using test_messages::expect_words;

using Files = std::map<std::string, std::string>;

constexpr double kRounding = 1e-12;

/// Left half white, right half black.
const std::string kHalves = png_of(2, 1, {255, 0}, {.colour = PNG_COLOR_TYPE_GRAY});
const std::string kRed = png_of(1, 1, {255, 0, 0});

/// A unit square of white texture, and one of 3 m2 of black.
const std::string kTwoFaces =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 4 0 0\nv 4 1 0\n"
    "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\n"
    "usemtl a\nf 1/1 2/2 3/3 4/4\nf 2/2/1 5/5/1 6/6/1 3/3/1\n";

SceneInput read(const std::string& obj, const Files& files, std::set<std::string>* asked = nullptr) {
  return read_obj_text("dir/a.obj", obj, [&](const std::filesystem::path& path) {
    if (asked != nullptr) asked->insert(path.string());
    const auto found = files.find(path.string());
    return found == files.end() ? std::nullopt : std::optional(found->second);
  });
}

SceneInput read_two_faces(const std::string& mtl, const Files& images = {{"dir/i.png", kHalves}}) {
  Files files = images;
  files["dir/m.mtl"] = mtl;
  return read(kTwoFaces, files);
}

std::string error_of(const std::string& obj, const Files& files) {
  try {
    static_cast<void>(read(obj, files));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string error_in_mtl(const std::string& mtl) {
  return error_of(kTwoFaces, {{"dir/m.mtl", mtl}, {"dir/i.png", kHalves}});
}

TEST(ObjTextures, MultiplyKdByTheMeanOfEachFace) {
  const SceneInput scene = read_two_faces("newmtl a\nKd 0.8 0.4 1\nmap_Kd i.png\n");
  ASSERT_EQ(scene.face_rho.size(), 2u);
  EXPECT_EQ(scene.face_rho[0], Rgb(0.8, 0.4, 1));
  EXPECT_EQ(scene.face_rho[1], Rgb(0));
  // 1 m2 of white and 3 m2 of black.
  for (int c = 0; c < kChannels; ++c)
    EXPECT_NEAR(scene.materials[0].rho[c], 0.25 * Rgb(0.8, 0.4, 1)[c], kRounding);
  EXPECT_TRUE(scene.materials[0].textured);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(ObjTextures, CountAMissingOrBlackKdAsOne) {
  const SceneInput missing = read_two_faces("newmtl a\nmap_Kd i.png\n");
  EXPECT_NEAR(missing.materials[0].rho.r, 0.25, kRounding);
  EXPECT_TRUE(missing.notes.empty());
  const SceneInput black = read_two_faces("newmtl a\nKd 0 0 0\nmap_Kd i.png\n");
  EXPECT_NEAR(black.materials[0].rho.r, 0.25, kRounding);
  ASSERT_EQ(black.notes.size(), 1u);
  expect_words(black.notes[0], {"dir/a.obj", "Kd of 0", "map_Kd", "taken as 1", "material a"});
}

TEST(ObjTextures, MultiplyKe) {
  const SceneInput scene = read_two_faces("newmtl a\nKd 0.5\nKe 8 4 2\nmap_Ke i.png\n");
  for (int c = 0; c < kChannels; ++c)
    EXPECT_NEAR(scene.materials[0].Ke[c], 0.25 * Rgb(8, 4, 2)[c], kRounding);
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.5));
  EXPECT_FALSE(scene.materials[0].textured);
  EXPECT_TRUE(scene.face_rho.empty());
  const SceneInput zero = read_two_faces("newmtl a\nKd 0.5\nKe 0 0 0\nmap_Ke i.png\n");
  EXPECT_NEAR(zero.materials[0].Ke.g, 0.25, kRounding);
  ASSERT_EQ(zero.notes.size(), 1u);
  expect_words(zero.notes[0], {"Ke of 0", "map_Ke", "taken as 1"});
}

TEST(ObjTextures, ApplyScaleAndOffset) {
  // u = 0.5 * (0 .. 0.5) + 0.25 = 0.25 .. 0.5, white; u = 0.5 * (0.5 .. 1) + 0.25 = 0.5 .. 0.75, black.
  const SceneInput scene =
      read_two_faces("newmtl a\nKd 1\nmap_Kd -s 0.5 1 1 -o 0.25 0 -clamp on -blendu off i.png\n");
  EXPECT_NEAR(scene.face_rho[0].r, 1, kRounding);
  EXPECT_NEAR(scene.face_rho[1].r, 0, kRounding);
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"dir/m.mtl: not used:", "map_Kd -blendu (1)", "map_Kd -clamp (1)"});
  const SceneInput shifted = read_two_faces("newmtl a\nKd 1\nmap_Kd -o 0.5 i.png\n");
  EXPECT_NEAR(shifted.face_rho[0].r, 0, kRounding);
  EXPECT_NEAR(shifted.face_rho[1].r, 1, kRounding);
}

TEST(ObjTextures, FindNamesWithBlanksAndBackslashes) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"map_Kd my wood #2.png ", "dir/my wood #2.png"},
      {"map_Kd tex\\wood.png", "dir/tex/wood.png"},
      {"map_Kd ../wood.png", "dir/../wood.png"},
      {"map_Kd /abs/wood.png", "/abs/wood.png"},
      {"map_Kd C:\\Users\\me\\wood.png", "dir/wood.png"},
      {"map_Kd -s 1 1 1 2.png", "dir/2.png"},
      {"map_Kd -s 2 3", "dir/3"},
      {"map_Kd -mm 0 1 -wood-.png", "dir/-wood-.png"}};
  for (const auto& [statement, file] : cases) {
    SCOPED_TRACE(statement);
    const SceneInput scene = read_two_faces("newmtl a\n" + statement + "\n", {{file, kHalves}});
    EXPECT_TRUE(scene.materials[0].textured);
  }
}

TEST(ObjTextures, LeaveKdWhereTheImageIsMissingOrOfAnotherFormat) {
  const SceneInput missing = read_two_faces("newmtl a\nKd 0.25\nmap_Kd gone.png\n");
  EXPECT_EQ(missing.materials[0].rho, Rgb(0.25));
  EXPECT_FALSE(missing.materials[0].textured);
  EXPECT_TRUE(missing.face_rho.empty());
  ASSERT_EQ(missing.notes.size(), 1u);
  expect_words(missing.notes[0],
               {"cannot find", "'dir/gone.png'", "material 'a'", "reflectance 0.25 0.25 0.25"});
  const SceneInput without = read_two_faces("newmtl a\nmap_Kd gone.png\n");
  EXPECT_EQ(without.materials[0].rho, Rgb(0.5));
  expect_words(without.notes.at(0), {"reflectance 0.5 0.5 0.5"});
  const SceneInput other = read_two_faces("newmtl a\nKd 0.25\nmap_Kd i.tga\n", {{"dir/i.tga", "TGA"}});
  EXPECT_EQ(other.materials[0].rho, Rgb(0.25));
  expect_words(other.notes.at(0), {"'dir/i.tga'", "neither PNG nor JPEG", "material 'a'"});
}

TEST(ObjTextures, RefuseADamagedImage) {
  expect_words(error_of(kTwoFaces, {{"dir/m.mtl", "newmtl a\nmap_Kd i.png\n"},
                                    {"dir/i.png", kHalves.substr(0, kHalves.size() / 2)}}),
               {"dir/i.png:", "damaged"});
}

TEST(ObjTextures, FacesWithoutCoordinatesHaveTheMeanOfTheImage) {
  const SceneInput scene = read(
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.1 0.1\nusemtl a\nf 1 2 3\nf 1/1 2 3\nf 1//1 2//1 3//1\n",
      {{"dir/m.mtl", "newmtl a\nKd 1\nmap_Kd i.png\n"}, {"dir/i.png", kHalves}});
  ASSERT_EQ(scene.face_rho.size(), 3u);
  for (const Rgb& rho : scene.face_rho) EXPECT_NEAR(rho.r, 0.5, kRounding);
}

TEST(ObjTextures, ReadRelativeAndForwardIndices) {
  const SceneInput scene = read(
      "usemtl a\nf 1/1 2/2 3/3\nmtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.5 0\nvt 1\nvt 1 1 7\n"
      "f -3/-3 -2/-2 -1/-1\n",
      {{"dir/m.mtl", "newmtl a\nKd 1\nmap_Kd i.png\n"}, {"dir/i.png", kHalves}});
  for (const Rgb& rho : scene.face_rho) EXPECT_NEAR(rho.r, 0, kRounding);
}

TEST(ObjTextures, OtherMaterialsKeepTheirOwn) {
  const SceneInput scene =
      read(kTwoFaces + "usemtl b\nf 1 2 3\nusemtl c\nf 1/1 2/2 3/3\n",
           {{"dir/m.mtl", "newmtl a\nKd 1\nmap_Kd i.png\nnewmtl b\nKd 0.2\nnewmtl c\nmap_Kd r.png\n"},
            {"dir/i.png", kHalves},
            {"dir/r.png", kRed}});
  ASSERT_EQ(scene.face_rho.size(), 4u);
  EXPECT_EQ(scene.face_rho[2], Rgb(0.2));
  EXPECT_EQ(scene.face_rho[3], Rgb(1, 0, 0));
  EXPECT_EQ(scene.materials[1].rho, Rgb(0.2));
  EXPECT_FALSE(scene.materials[1].textured);
  EXPECT_EQ(scene.materials[2].rho, Rgb(1, 0, 0));
}

TEST(ObjTextures, ImagesOfUnusedMaterialsAreNotRead) {
  std::set<std::string> asked;
  static_cast<void>(
      read(kTwoFaces, {{"dir/m.mtl", "newmtl a\nKd 1\nnewmtl b\nKd 1\nmap_Kd i.png\n"}, {"dir/i.png", "x"}},
           &asked));
  EXPECT_FALSE(asked.contains("dir/i.png"));
}

TEST(ObjTextures, NoteTransparentPixels) {
  const std::string glass = png_of(1, 1, {255, 255, 255, 0}, {.colour = PNG_COLOR_TYPE_RGBA});
  const SceneInput scene = read_two_faces("newmtl a\nmap_Kd g.png\n", {{"dir/g.png", glass}});
  EXPECT_EQ(scene.materials[0].rho, Rgb(1));
  expect_words(scene.notes.at(0), {"'dir/g.png'", "transparent", "opaque"});
}

TEST(ObjTextures, RefuseBadMaps) {
  expect_words(error_in_mtl("map_Kd i.png\n"), {"dir/m.mtl:1:", "map_Kd stands before any newmtl"});
  expect_words(error_in_mtl("newmtl a\nmap_Kd\n"), {"dir/m.mtl:2:", "map_Kd names no image"});
  expect_words(error_in_mtl("newmtl a\nmap_Kd -s i.png\n"), {"dir/m.mtl:2:", "map_Kd -s", "too few values"});
  expect_words(error_in_mtl("newmtl a\nmap_Ke -s x y i.png\n"),
               {"dir/m.mtl:2:", "scale", "'x'", "not a number"});
  expect_words(error_in_mtl("newmtl a\nmap_Ke -o nan i.png\n"),
               {"dir/m.mtl:2:", "offset", "'nan'", "finite"});
}

TEST(ObjTextures, RefuseBadTextureCoordinates) {
  const Files files{{"dir/m.mtl", "newmtl a\nmap_Kd i.png\nnewmtl b\nKd 0\n"}, {"dir/i.png", kHalves}};
  const std::string start = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\n";
  expect_words(error_of(start + "vt x 0\n", files), {"dir/a.obj:5:", "texture coordinate", "'x'"});
  expect_words(error_of(start + "vt\n", files), {"dir/a.obj:5:", "texture coordinate", "too few"});
  expect_words(error_of(start + "vt 1e99 0\n", files), {"dir/a.obj:5:", "texture coordinate", "too large"});
  expect_words(error_of(start + "vt 0 0\nusemtl a\nf 1/1 2/2 3/1\n", files),
               {"dir/a.obj:7:", "texture index '2'", "out of range", "1 texture coordinates"});
  expect_words(error_of(start + "vt 0 0\nusemtl a\nf 1/-2 2/1 3/1\n", files),
               {"dir/a.obj:7:", "texture index '1/-2'", "out of range"});
  EXPECT_EQ(error_of(start + "usemtl b\nf 1/9 2/9 3/-9\n", files), "no error");
}

// Scene files

SceneInput read_scene(const std::string& text, const Files& files) {
  return read_scene_text("dir/scene.toml", text, [&](const std::filesystem::path& path) {
    const auto found = files.find(path.string());
    return found == files.end() ? std::nullopt : std::optional(found->second);
  });
}

const Files kSceneFiles{
    {"dir/white.obj",
     "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 1\nusemtl a\nf 1/1 2/2 3/3\n"},
    {"dir/black.obj",
     "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.5 0\nvt 1 0\nvt 1 1\nusemtl a\nf 1/1 2/2 3/3\n"},
    {"dir/m.mtl", "newmtl a\nKd 0.8\nmap_Kd i.png\n"},
    {"dir/i.png", kHalves}};
const std::string kTwoGeometries =
    "[[geometry]]\nfile = \"white.obj\"\n[[geometry]]\nfile = \"black.obj\"\nmetres_per_unit = 2\n";

TEST(ObjTextures, AMaterialOfSeveralFilesHasTheMeanOverAll) {
  const SceneInput scene = read_scene(kTwoGeometries, kSceneFiles);
  ASSERT_EQ(scene.materials.size(), 1u);
  // Of 0.5 m2 and 0.8, and of 2 m2 and 0.
  EXPECT_NEAR(scene.materials[0].rho.r, 0.8 * 0.2, kRounding);
  EXPECT_NEAR(scene.face_rho.at(0).r, 0.8, kRounding);
  EXPECT_NEAR(scene.face_rho.at(1).r, 0, kRounding);
}

TEST(ObjTextures, TheSceneFilesReflectanceStandsAboveTextures) {
  const SceneInput scene = read_scene(kTwoGeometries + "[materials.a]\nrho = 0.6\n", kSceneFiles);
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.6));
  EXPECT_FALSE(scene.materials[0].textured);
  for (const Rgb& rho : scene.face_rho) EXPECT_EQ(rho, Rgb(0.6));
  EXPECT_TRUE(read_scene(kTwoGeometries + "[materials.a]\nE = 1\n", kSceneFiles).materials[0].textured);
}

}  // namespace
}  // namespace fluxel::obj_textures_test
