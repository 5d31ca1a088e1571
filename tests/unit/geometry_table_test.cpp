#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/options.hpp"
#include "scene/readers/scene_file.hpp"
#include "scene/triangulate.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::geometry_table_test {
namespace {

using test_messages::expect_words;

const std::string kObj =
    "mtllib box.mtl\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 3 5 7\n"
    "g a\nusemtl white\nf 1 2 3\ng b\nusemtl light\nf 1 4 2\n";
const std::string kMtl = "newmtl white\nKd 0.5 0.5 0.5\nnewmtl light\nKd 0 0 0\nKe 1 2 3\n";
const std::string kStl =
    "solid bare\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
    "0\nendloop\nendfacet\n"
    "endsolid\n";
const std::string kGeometry = "[[geometry]]\nfile = \"box.obj\"\n";

SceneInput read(const std::string& text) {
  return read_scene_text("dir/scene.toml", text,
                         [](const std::filesystem::path& path) -> std::optional<std::string> {
                           if (path == "dir/box.obj") return kObj;
                           if (path == "dir/box.mtl") return kMtl;
                           if (path == "dir/bare.stl") return kStl;
                           if (path == "dir/mixed.obj") return "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + kObj;
                           return std::nullopt;
                         });
}

/// The points (1,0,0), (0,1,0), (0,0,1) as a placing brings them into the scene.
std::vector<glm::dvec3> axes_of(const std::string& placing) {
  return read(kGeometry + placing).polygons.at(0).corners;
}

using Points = std::vector<glm::dvec3>;

TEST(GeometryTable, NamesTheMaterialOfFacesThatHaveNone) {
  const std::string bare = "[[geometry]]\nfile = \"bare.stl\"\n";
  const SceneInput scene =
      read(bare + "material = \"plaster\"\n" + kGeometry + bare + "material = \"door\"\n" + bare + bare +
           "material = \"plaster\"\n[materials.plaster]\nrho = 0.8\n");
  std::vector<std::string> names;
  for (const InputMaterial& material : scene.materials) names.push_back(material.name);
  EXPECT_EQ(names, (std::vector<std::string>{"plaster", "white", "light", "door", "default"}));
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.8));
  EXPECT_EQ(scene.materials[3].rho, Rgb(0.5));
  EXPECT_EQ(scene.polygons.back().material, scene.polygons.front().material);
}

TEST(GeometryTable, RefusesToNameWhatHasAName) {
  const auto error_of = [](const std::string& file, const std::string& name) -> std::string {
    try {
      static_cast<void>(read("[[geometry]]\nfile = \"" + file + "\"\nmaterial = " + name + "\n"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  expect_words(error_of("box.obj", "\"plaster\""), {":3:", "box.obj", "of their own", "[materials.NAME]"});
  expect_words(error_of("mixed.obj", "\"light\""), {":3:", "'light'", "already"});
  expect_words(error_of("bare.stl", "\"\""), {":3:", "no name"});
  expect_words(error_of("bare.stl", "3"), {":3:", "material must be a text"});
  EXPECT_EQ(error_of("mixed.obj", "\"plaster\""), "no error");
}

TEST(GeometryTable, QuarterTurnsAreExact) {
  EXPECT_EQ(axes_of("rotate = [0, 0, 1, 90]\n"), (Points{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}));
  EXPECT_EQ(axes_of("rotate = [0, 0, 2.5, -90]\n"), (Points{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}));
  EXPECT_EQ(axes_of("rotate = [1, 0, 0, 180]\n"), (Points{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}));
  EXPECT_EQ(axes_of("rotate = [0, 1, 0, 630]\n"), (Points{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}));
  EXPECT_EQ(axes_of("rotate = [0, 1, 0, 360]\n"), (Points{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

TEST(GeometryTable, OtherTurnsFollowTheRightHand) {
  const double c = std::cos(glm::radians(30.0)), s = 0.5;
  const Points turned = axes_of("rotate = [0, 0, 1, 30]\n");
  EXPECT_LT(glm::distance(turned[0], {c, s, 0}), 1e-15);
  EXPECT_LT(glm::distance(turned[1], {-s, c, 0}), 1e-15);
  const Points back = axes_of("rotate = [0, 0, 1, 150]\n");
  EXPECT_LT(glm::distance(back[0], {-c, s, 0}), 1e-15);
  // A third of a turn about the diagonal of a cube exchanges its axes; its length does not matter.
  const Points exchanged = axes_of("rotate = [1e200, 1e200, 1e200, 120]\n");
  EXPECT_LT(glm::distance(exchanged[0], {0, 1, 0}), 1e-15);
  EXPECT_LT(glm::distance(exchanged[1], {0, 0, 1}), 1e-15);
  EXPECT_LT(glm::distance(exchanged[2], {1, 0, 0}), 1e-15);
}

TEST(GeometryTable, TurnsAreAppliedInOrder) {
  EXPECT_EQ(axes_of("rotate = [[0, 0, 1, 90], [1, 0, 0, 90]]\n"),
            (Points{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}));
}

TEST(GeometryTable, ScalesAsAWholeOrByAxis) {
  EXPECT_EQ(axes_of("scale = 2\n"), (Points{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}));
  EXPECT_EQ(axes_of("scale = [2, 3, 0.5]\n"), (Points{{2, 0, 0}, {0, 3, 0}, {0, 0, 0.5}}));
}

TEST(GeometryTable, MirrorThenScaleThenTurnThenUnitThenShift) {
  const Points placed = axes_of(
      "translate = [10, 20, 30]\nmetres_per_unit = 0.5\nrotate = [0, 0, 1, 90]\nscale = [4, 2, 2]\n"
      "mirror = \"x\"\n");
  // Reversed, since it is a mirror image: the third point first.
  EXPECT_EQ(placed, (Points{{10, 20, 31}, {9, 20, 30}, {10, 18, 30}}));
}

TEST(GeometryTable, MirrorsKeepFronts) {
  for (const auto& [placing, sign] : {std::pair(std::string("mirror = \"x\"\n"), glm::dvec3(-1, 1, 1)),
                                      {"mirror = \"y\"\n", {1, -1, 1}},
                                      {"mirror = \"z\"\n", {1, 1, -1}},
                                      {"scale = [1, -1, 1]\n", {1, -1, 1}},
                                      {"scale = -1\n", {-1, -1, -1}},
                                      {"mirror = \"z\"\nscale = [1, 1, -1]\n", {1, 1, 1}}}) {
    const SceneInput plain = read(kGeometry), placed = read(kGeometry + placing);
    for (std::size_t k = 0; k < plain.polygons.size(); ++k)
      EXPECT_EQ(vector_area(placed.polygons[k].corners), vector_area(plain.polygons[k].corners) * sign)
          << placing << k;
  }
}

TEST(GeometryTable, OneFileMayStandTwice) {
  const SceneInput scene = read(kGeometry + kGeometry + "rotate = [0, 0, 1, 180]\ntranslate = [5, 0, 0]\n");
  EXPECT_EQ(scene.groups, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(scene.materials.size(), 2u);
  ASSERT_EQ(scene.polygons.size(), 4u);
  EXPECT_EQ(scene.polygons[2].material, scene.polygons[0].material);
  EXPECT_EQ(scene.polygons[3].group, scene.polygons[1].group);
  EXPECT_EQ(scene.polygons[0].corners[0], glm::dvec3(1, 0, 0));
  EXPECT_EQ(scene.polygons[2].corners[0], glm::dvec3(4, 0, 0));
  EXPECT_EQ(scene.geometry.size(), 2u);
}

TEST(GeometryTable, KnowsWhetherAUnitIsGiven) {
  EXPECT_FALSE(read(kGeometry).geometry.at(0).unit_given);
  EXPECT_TRUE(read(kGeometry + "metres_per_unit = 1\n").geometry.at(0).unit_given);
}

TEST(GeometryTable, RefusesBadPlacing) {
  const auto error_of = [](const std::string& placing) -> std::string {
    try {
      static_cast<void>(read(kGeometry + placing));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  for (const std::string scale : {"0", "[1, 0, 1]", "1e-10", "[1, 1, -1e10]"})
    expect_words(error_of("scale = " + scale + "\n"), {"scene.toml:3:", "scale is", "mirrors"});
  expect_words(error_of("scale = [1, 1]\n"), {":3:", "scale", "array of 3"});
  expect_words(error_of("scale = nan\n"), {":3:", "scale", "finite"});
  expect_words(error_of("scale = \"2\"\n"), {":3:", "scale", "number"});
  for (const std::string mirror : {"w", "X", "", "xy"})
    expect_words(error_of("mirror = \"" + mirror + "\"\n"),
                 {":3:", "mirror is '" + mirror + "'", "x, y or z"});
  expect_words(error_of("mirror = 1\n"), {":3:", "mirror must be a text"});
  for (const std::string rotate : {"90", "[]", "[0, 0, 90]", "[[0, 0, 1, 90], 3]", "[[0, 0, 1]]", "[[[0]]]"})
    expect_words(error_of("rotate = " + rotate + "\n"), {":3:", "rotate must be four numbers", "axis_x"});
  expect_words(error_of("rotate = [0, 0, \"1\", 90]\n"), {":3:", "rotate must be a number"});
  expect_words(error_of("rotate = [0, 0, inf, 90]\n"), {":3:", "rotate must be finite"});
  expect_words(error_of("rotate = [0, 0, 0, 90]\n"), {":3:", "axis of 0"});
  expect_words(error_of("rotate = [0, 0, 1, 1e9]\n"), {":3:", "degrees"});
}

}  // namespace
}  // namespace fluxel::geometry_table_test
