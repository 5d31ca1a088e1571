#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/options.hpp"
#include "scene/readers/scene_file.hpp"
#include "scene/triangulate.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::primitive_table_test {
namespace {

using test_messages::expect_words;

SceneInput read(const std::string& keys) {
  return read_scene_text("dir/scene.toml", "[[geometry]]\n" + keys,
                         [](const std::filesystem::path& path) -> std::optional<std::string> {
                           if (path == "dir/a.stl")
                             return "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                    "vertex 0 1 0\nendloop\nendfacet\nendsolid\n";
                           return std::nullopt;
                         });
}

/// Six times the volume that the polygons enclose, above 0 where their fronts are outside.
double six_volumes(const SceneInput& scene) {
  double sum = 0;
  for (const InputPolygon& polygon : scene.polygons)
    sum += 2 * glm::dot(polygon.corners.front(), vector_area(polygon.corners));
  return sum;
}

TEST(PrimitiveTable, ABoxIsClosedAndItsFrontsAreOutside) {
  const SceneInput scene = read("box = [4, 3, 2.5]\n");
  ASSERT_EQ(scene.polygons.size(), 6u);
  EXPECT_EQ(scene.groups,
            (std::vector<std::string>{"box -x", "box +x", "box -y", "box +y", "box -z", "box +z"}));
  EXPECT_DOUBLE_EQ(six_volumes(scene), 6 * 4 * 3 * 2.5);
  glm::dvec3 all(0);
  for (std::size_t side = 0; side < 6; ++side) {
    const std::vector<glm::dvec3>& corners = scene.polygons[side].corners;
    const glm::dvec3 normal = vector_area(corners);
    glm::dvec3 expected(0);
    const glm::dvec3 areas(7.5, 10, 12);
    const auto axis = static_cast<int>(side / 2);
    expected[axis] = side % 2 == 0 ? -areas[axis] : areas[axis];
    EXPECT_EQ(normal, expected) << scene.groups[side];
    for (const glm::dvec3& corner : corners)
      EXPECT_EQ(corner[axis], side % 2 == 0 ? 0 : (glm::dvec3(4, 3, 2.5))[axis]);
    all += normal;
  }
  EXPECT_EQ(all, glm::dvec3(0));
}

TEST(PrimitiveTable, ARoomFacesInwards) {
  EXPECT_DOUBLE_EQ(six_volumes(read("box = [4, 3, 2.5]\ninwards = true\n")), -6 * 4 * 3 * 2.5);
  EXPECT_DOUBLE_EQ(six_volumes(read("box = [4, 3, 2.5]\ninwards = false\n")), 6 * 4 * 3 * 2.5);
}

TEST(PrimitiveTable, ARectangleFacesUp) {
  const SceneInput scene = read("rectangle = [2, 0.5]\ngroup = \"lamp\"\nmaterial = \"light\"\n");
  ASSERT_EQ(scene.polygons.size(), 1u);
  EXPECT_EQ(vector_area(scene.polygons[0].corners), glm::dvec3(0, 0, 1));
  EXPECT_EQ(scene.groups, (std::vector<std::string>{"lamp"}));
  EXPECT_EQ(scene.materials.at(0).name, "light");
}

TEST(PrimitiveTable, IsPlacedAsFilesAre) {
  const SceneInput scene =
      read("rectangle = [2, 1]\nrotate = [1, 0, 0, 180]\ntranslate = [1, 2, 2.5]\nmetres_per_unit = 0.5\n");
  EXPECT_EQ(scene.polygons.at(0).corners,
            (std::vector<glm::dvec3>{{1, 2, 2.5}, {2, 2, 2.5}, {2, 1.5, 2.5}, {1, 1.5, 2.5}}));
  EXPECT_TRUE(scene.geometry.at(0).unit_given);
  EXPECT_GT(six_volumes(read("box = [1, 2, 3]\nmirror = \"x\"\n")), 0);
}

TEST(PrimitiveTable, SidesMayHaveMaterialsOfTheirOwn) {
  const SceneInput scene = read(
      "box = [4, 3, 2.5]\nmaterial = \"wall\"\nmaterial_of = { \"-z\" = \"floor\", \"+z\" = \"white\" "
      "}\ngroup = \"room\"\n"
      "[[geometry]]\nbox = [1, 1, 1]\nmaterial = \"floor\"\n"
      "[materials]\nfloor.rho = 0.2\nwall.rho = 0.5\nwhite.rho = 0.7\n");
  std::vector<std::string> names;
  for (const InputPolygon& polygon : scene.polygons)
    names.push_back(scene.materials[index(polygon.material)].name);
  EXPECT_EQ(names, (std::vector<std::string>{"wall", "wall", "wall", "wall", "floor", "white", "floor",
                                             "floor", "floor", "floor", "floor", "floor"}));
  EXPECT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.materials[index(scene.polygons[4].material)].rho, Rgb(0.2));
  EXPECT_EQ(scene.groups[4], "room -z");
}

TEST(PrimitiveTable, AMaterialOfAFileCountsWhateverComesFirst) {
  const std::string file = "[[geometry]]\nfile = \"wall.obj\"\n";
  const std::string shape = "[[geometry]]\nrectangle = [1, 1]\nmaterial = \"wall\"\n";
  for (const std::string& text : {file + shape, shape + file, shape + shape + file + shape}) {
    const auto lookup = [](const std::filesystem::path& path) -> std::optional<std::string> {
      if (path == "dir/wall.obj") return "mtllib wall.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wall\nf 1 2 3\n";
      if (path == "dir/wall.mtl") return "newmtl wall\nKd 0.9 0.1 0.1\n";
      return std::nullopt;
    };
    const SceneInput scene = read_scene_text("dir/scene.toml", text, lookup);
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].rho, Rgb(0.9, 0.1, 0.1));
    const SceneInput changed =
        read_scene_text("dir/scene.toml", text + "[materials.wall]\nrho = 0.3\n", lookup);
    EXPECT_EQ(changed.materials[0].rho, Rgb(0.3));
  }
}

TEST(PrimitiveTable, RefusesWhatIsWrong) {
  const auto error_of = [](const std::string& keys) -> std::string {
    try {
      static_cast<void>(read(keys));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  for (const std::string side : {"0", "-1", "1e16"})
    expect_words(error_of("box = [1, " + side + ", 1]\n"),
                 {"scene.toml:2:", "box has a side of", "greater than 0"});
  expect_words(error_of("box = [1, nan, 1]\n"), {":2:", "box must be finite"});
  expect_words(error_of("box = [1, 1]\n"), {":2:", "box must be an array of 3"});
  expect_words(error_of("rectangle = [1, 1, 1]\n"), {":2:", "rectangle must be an array of 2"});
  expect_words(error_of("box = [1, 1, 1]\nrectangle = [1, 1]\n"),
               {":3:", "two shapes", "another [[geometry]]"});
  expect_words(error_of("file = \"a.stl\"\nrectangle = [1, 1]\n"), {":2:", "two shapes"});
  expect_words(error_of("file = \"a.stl\"\nbox = [1, 1, 1]\n"), {":2:", "two shapes"});
  expect_words(error_of("file = \"a.stl\"\ninwards = true\n"), {":3:", "inwards is of shapes alone"});
  expect_words(error_of("file = \"a.stl\"\ngroup = \"b\"\n"), {":3:", "group is of shapes alone"});
  expect_words(error_of("rectangle = [1, 1]\ninwards = true\n"), {":3:", "inwards is of a box alone"});
  expect_words(error_of("rectangle = [1, 1]\nmaterial_of = {}\n"), {":3:", "material_of is of a box alone"});
  expect_words(error_of("box = [1, 1, 1]\ninwards = 1\n"), {":3:", "true or false"});
  expect_words(error_of("box = [1, 1, 1]\nmaterial_of = { top = \"a\" }\n"),
               {":3:", "unknown key 'top'", "+z"});
  expect_words(error_of("box = [1, 1, 1]\nmaterial_of = { \"+z\" = \"\" }\n"),
               {":3:", "material_of is empty"});
  expect_words(error_of("box = [1, 1, 1]\nmaterial = \"\"\n"), {":3:", "material is empty"});
  expect_words(error_of("box = [1, 1, 1]\ngroup = \"a\\u001b[31m\"\n"),
               {":3:", "group has a control character"});
  expect_words(error_of("box = [1, 1, 1]\ngroup = 3\n"), {":3:", "group must be a text"});
  expect_words(error_of("material = \"a\"\n"), {":1:", "names no file", "box = "});
}

}  // namespace
}  // namespace fluxel::primitive_table_test
