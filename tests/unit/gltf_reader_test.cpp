#include "scene/readers/gltf_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/readers/geometry_formats.hpp"
#include "tests/unit/gltf_files.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::gltf_reader_test {
namespace {

using gltf_files::add_accessor;
using gltf_files::bytes_of;
using gltf_files::json;
using gltf_files::read;
using gltf_files::Triangle;
using test_messages::expect_words;

using Corners = std::vector<glm::dvec3>;

constexpr double kPi = std::numbers::pi;

SceneInput read(const Triangle& triangle) { return read(triangle.text()); }

void expect_near(const Corners& corners, const Corners& expected) {
  ASSERT_EQ(corners.size(), expected.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(corners[k][axis], expected[k][axis], 1e-12) << k << axis;
  }
}

std::size_t notes_with(const SceneInput& scene, const std::string& word) {
  return static_cast<std::size_t>(std::ranges::count_if(
      scene.notes, [&](const std::string& note) { return note.find(word) != note.npos; }));
}

TEST(GltfReader, ReadsATriangle) {
  Triangle triangle;
  triangle["/materials"] = json::parse(
      R"([{"name": "red", "doubleSided": true, "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.2, 1],
          "metallicFactor": 0}}])");
  triangle.primitive()["material"] = 0;
  const SceneInput scene = read(triangle);
  EXPECT_EQ(scene.name, "a");
  ASSERT_EQ(scene.polygons.size(), 1u);
  EXPECT_EQ(scene.polygons[0].corners, (Corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(scene.groups, std::vector<std::string>{"leaf"});
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "red");
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.8, 0.1, 0.2));
  EXPECT_EQ(scene.materials[0].E, Rgb(0));
  EXPECT_EQ(scene.materials[0].sides, Sides::two);
  EXPECT_FALSE(scene.units.has_value());
  EXPECT_TRUE(scene.face_rho.empty());
  EXPECT_TRUE(scene.notes.empty());
}

TEST(GltfReader, IsFoundByItsExtensions) {
  for (const char* const name : {"a.gltf", "a.GLB"}) {
    const GeometryFormat* const format = geometry_format(name);
    ASSERT_NE(format, nullptr) << name;
    EXPECT_EQ(format->read, &read_gltf);
  }
}

TEST(GltfReader, PlacesNodesByTheirParents) {
  Triangle triangle;
  // 90 degrees about z, then doubled in x, then moved; the parent is a matrix that moves by 10 in y.
  const double half = std::sqrt(0.5);
  triangle["/nodes"] = {
      {{"children", {1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 10, 0, 1}}},
      {{"mesh", 0}, {"rotation", {0, 0, half, half}}, {"scale", {2, 1, 1}}, {"translation", {0, 0, 5}}}};
  // translation * rotation * scale: (1,0,0) -> (2,0,0) -> (0,2,0) -> (0,12,5).
  expect_near(read(triangle).polygons[0].corners, {{0, 10, 5}, {0, 12, 5}, {-1, 10, 5}});
}

TEST(GltfReader, MirroredNodesKeepTheirFront) {
  Triangle triangle;
  triangle["/nodes/0/scale"] = {-1, 1, 1};
  const Corners corners = read(triangle).polygons[0].corners;
  // The normal (0,0,1), which the mirror does not change.
  EXPECT_GT(glm::cross(corners[1] - corners[0], corners[2] - corners[0]).z, 0);
  EXPECT_EQ(corners, (Corners{{0, 1, 0}, {-1, 0, 0}, {0, 0, 0}}));
}

TEST(GltfReader, ReadsTheDefaultSceneAlone) {
  Triangle triangle;
  triangle["/nodes"] = {{{"mesh", 0}, {"name", "one"}}, {{"mesh", 0}, {"name", "two"}}};
  EXPECT_EQ(read(triangle).groups, (std::vector<std::string>{"one", "two"}));  // no scene: all nodes
  triangle["/scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  const SceneInput first = read(triangle);
  EXPECT_EQ(first.groups, std::vector<std::string>{"one"});
  EXPECT_EQ(notes_with(first, "scenes beside the default one are left out (1)"), 1u);
  triangle["/scene"] = 1;
  EXPECT_EQ(read(triangle).groups, std::vector<std::string>{"two"});
}

TEST(GltfReader, NodesOfOneNameAreOneGroup) {
  Triangle triangle;
  triangle["/meshes/0/name"] = "chair";
  triangle["/nodes"] = {
      {{"mesh", 0}}, {{"mesh", 0}, {"name", "table"}}, {{"mesh", 0}, {"translation", {1, 2, 3}}}};
  const SceneInput scene = read(triangle);
  EXPECT_EQ(scene.groups, (std::vector<std::string>{"chair", "table"}));
  ASSERT_EQ(scene.polygons.size(), 3u);
  EXPECT_EQ(index(scene.polygons[2].group), 0u);
  EXPECT_EQ(scene.polygons[2].corners[1], glm::dvec3(2, 2, 3));
}

TEST(GltfReader, ReadsListsStripsAndFansWithoutIndices) {
  Triangle triangle;
  triangle.primitive().erase("indices");
  // Five points on a zigzag, named by x: a strip's triangles turn the same way.
  const std::size_t points =
      add_accessor(triangle.document, triangle.buffer,
                   bytes_of<float>({0, 0, 0, 1, 1, 0, 2, 0, 0, 3, 1, 0, 4, 0, 0}), 5126, "VEC3", 5);
  triangle.primitive()["attributes"]["POSITION"] = points;
  const auto corners_of = [&](int mode) {
    triangle.primitive()["mode"] = mode;
    std::vector<std::vector<double>> named;
    for (const InputPolygon& polygon : read(triangle).polygons) {
      std::vector<double>& names = named.emplace_back();
      for (const glm::dvec3& corner : polygon.corners) names.push_back(corner.x);
    }
    return named;
  };
  using Names = std::vector<std::vector<double>>;
  EXPECT_EQ(corners_of(5), (Names{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(corners_of(6), (Names{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  triangle["/accessors/2/count"] = 3;
  EXPECT_EQ(corners_of(4), (Names{{0, 1, 2}}));
}

TEST(GltfReader, JointsOfStripsAreNoTriangles) {
  Triangle triangle;
  triangle.primitive()["mode"] = 5;
  triangle.primitive()["indices"] =
      add_accessor(triangle.document, triangle.buffer, bytes_of<std::uint8_t>({0, 1, 2, 2, 0, 0, 1, 2}), 5121,
                   "SCALAR", 8);
  EXPECT_EQ(read(triangle).polygons.size(), 2u);
}

TEST(GltfReader, CountsPointsAndLinesThatItLeavesOut) {
  Triangle triangle;
  for (const int mode : {0, 1, 3})
    triangle["/meshes/0/primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
  const SceneInput scene = read(triangle);
  EXPECT_EQ(scene.polygons.size(), 1u);
  EXPECT_EQ(notes_with(scene, "primitives of points or lines are left out (3)"), 1u);
}

TEST(GltfReader, ReadsStridesAndOffsets) {
  Triangle triangle;
  // Positions behind a float each, 16 bytes apart.
  const std::string interleaved = bytes_of<float>({9, 0, 0, 2, 9, 1, 0, 2, 9, 0, 1, 2});
  triangle.primitive()["attributes"]["POSITION"] =
      add_accessor(triangle.document, triangle.buffer, interleaved, 5126, "VEC3", 3);
  triangle["/bufferViews/2/byteStride"] = 16;
  triangle["/accessors/2/byteOffset"] = 4;
  EXPECT_EQ(read(triangle).polygons[0].corners, (Corners{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}));
}

TEST(GltfReader, ReadsQuantisedPositions) {
  Triangle triangle;
  triangle["/extensionsRequired"] = {"KHR_mesh_quantization"};
  triangle["/nodes/0/scale"] = {0.5, 1, 1};
  const std::size_t shorts =
      add_accessor(triangle.document, triangle.buffer,
                   bytes_of<std::int16_t>({0, 0, 0, 0, -32768, 0, 0, 0, 0, 32767, 0, 0}), 5122, "VEC3", 3);
  triangle["/bufferViews/2/byteStride"] = 8;
  triangle.primitive()["attributes"]["POSITION"] = shorts;
  EXPECT_EQ(read(triangle).polygons[0].corners, (Corners{{0, 0, 0}, {-16384, 0, 0}, {0, 32767, 0}}));
  triangle["/accessors/2/normalized"] = true;
  EXPECT_EQ(read(triangle).polygons[0].corners, (Corners{{0, 0, 0}, {-0.5, 0, 0}, {0, 1, 0}}));
  const std::size_t bytes =
      add_accessor(triangle.document, triangle.buffer,
                   bytes_of<std::uint8_t>({0, 0, 0, 0, 255, 0, 0, 0, 0, 51, 0, 0}), 5121, "VEC3", 3);
  triangle["/bufferViews/3/byteStride"] = 4;
  triangle["/accessors/3/normalized"] = true;
  triangle.primitive()["attributes"]["POSITION"] = bytes;
  expect_near(read(triangle).polygons[0].corners, {{0, 0, 0}, {0.5, 0, 0}, {0, 0.2, 0}});
}

TEST(GltfReader, ReadsSparsePositions) {
  Triangle triangle;
  const std::size_t where =
      gltf_files::add_view(triangle.document, triangle.buffer, bytes_of<std::uint8_t>({0, 2}));
  const std::size_t what =
      gltf_files::add_view(triangle.document, triangle.buffer, bytes_of<float>({0, 0, 7, 0, 3, 7}));
  triangle["/accessors/0/sparse"] = {{"count", 2},
                                     {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                     {"values", {{"bufferView", what}}}};
  EXPECT_EQ(read(triangle).polygons[0].corners, (Corners{{0, 0, 7}, {1, 0, 0}, {0, 3, 7}}));
  triangle["/accessors/0"].erase("bufferView");  // what is not replaced is zero
  EXPECT_EQ(read(triangle).polygons[0].corners, (Corners{{0, 0, 7}, {0, 0, 0}, {0, 3, 7}}));
}

TEST(GltfReader, TrianglesWithoutMaterialGetTheDefaultAndANote) {
  Triangle triangle;
  triangle["/materials"] = {
      {{"name", "default"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 0}}}}};
  const SceneInput scene = read(triangle);
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[1].name, "default 2");
  EXPECT_EQ(scene.materials[1].rho, Rgb(0.5));
  EXPECT_EQ(index(scene.polygons[0].material), 1u);
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"1 of 1 triangles", "no material", "'default 2'", "0.5"});
}

TEST(GltfReader, NamesOfMaterialsDiffer) {
  Triangle triangle;
  triangle["/materials"] = {
      {{"name", "a"}}, {{"name", "a 2"}}, {{"name", "a"}}, json::object(), {{"name", "a"}}};
  std::vector<std::string> names;
  for (const InputMaterial& material : read(triangle).materials) names.push_back(material.name);
  EXPECT_EQ(std::vector<std::string>(names.begin(), names.begin() + 5),
            (std::vector<std::string>{"a", "a 2", "a 3", "material 3", "a 4"}));
}

TEST(GltfReader, EmissionIsALuminance) {
  Triangle triangle;
  triangle["/materials"] = json::parse(R"([{"emissiveFactor": [1, 0.5, 0],
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 200}}}])");
  const SceneInput scene = read(triangle);
  EXPECT_EQ(scene.units, Units::photometric);
  ASSERT_TRUE(scene.materials[0].E.has_value());
  EXPECT_DOUBLE_EQ(scene.materials[0].E->r, kPi * 200);
  EXPECT_DOUBLE_EQ(scene.materials[0].E->g, kPi * 100);
  EXPECT_DOUBLE_EQ(scene.materials[0].E->b, 0);
  EXPECT_EQ(scene.materials[0].sides, Sides::one);
}

TEST(GltfReader, ReadsPerspectiveCameras) {
  Triangle triangle;
  triangle["/cameras"] = json::parse(
      R"([{"name": "lens", "type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
          {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}}])");
  // Turned by 90 degrees about y: ahead is -x.
  const double half = std::sqrt(0.5);
  triangle["/nodes"] = {
      {{"mesh", 0}},
      {{"camera", 0}, {"translation", {1, 2, 3}}, {"rotation", {0, half, 0, half}}, {"scale", {5, 5, 5}}},
      {{"camera", 0}},
      {{"camera", 1}}};
  const SceneInput scene = read(triangle);
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name->value, "lens");
  EXPECT_EQ(scene.cameras[1].name->value, "lens 2");
  expect_near({scene.cameras[0].eye->value, scene.cameras[0].look_at->value, scene.cameras[0].up->value},
              {{1, 2, 3}, {0, 2, 3}, {0, 1, 0}});
  expect_near({scene.cameras[1].look_at->value}, {{0, 0, -1}});
  EXPECT_DOUBLE_EQ(scene.cameras[0].fov->value, 0.5 * 180 / kPi);
  EXPECT_EQ(notes_with(scene, "orthographic cameras are left out (1)"), 1u);
}

TEST(GltfReader, NotesWhatItTakesForSomethingElse) {
  Triangle triangle;
  triangle["/extensionsUsed"] = {"KHR_materials_clearcoat", "EXT_mesh_gpu_instancing"};
  triangle["/images"] = json::array({{{"uri", "n.png"}}});
  triangle["/textures"] = {{{"source", 0}}};
  triangle["/samplers"] = {{{"wrapS", 33071}}};
  triangle["/animations"] = json::array({json::object(), json::object()});
  triangle["/skins"] = json::array({{{"joints", {0}}}});
  triangle["/materials"] = json::parse(R"([
    {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1]}, "normalTexture": {"index": 0}},
    {"pbrMetallicRoughness": {"metallicFactor": 0, "metallicRoughnessTexture": {"index": 0}}, "alphaMode": "MASK",
     "occlusionTexture": {"index": 0}, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}},
    {"alphaMode": "BLEND"}])");
  triangle.primitive()["targets"] = json::array({{{"POSITION", 0}}});
  triangle.primitive()["attributes"]["COLOR_0"] = 0;
  triangle.primitive()["material"] = 0;
  const SceneInput scene = read(triangle);
  for (const char* const words :
       {"extensions that are not read: 'EXT_mesh_gpu_instancing'", "animations are left out (2)",
        "skins are left out, their meshes taken at rest (1)", "no base colour, so reflectance 1 (2)",
        "their base colour as reflectance (1)",
        "alphaMode MASK or BLEND, opaque unless a scene file says more (2)",
        "normalTexture, taken as smooth (1)", "occlusionTexture, left out: occlusion is computed (1)",
        "metallicRoughnessTexture, taken as diffuse (1)",
        "KHR_materials_clearcoat, diffuse and opaque without it unless a scene file says more (1)",
        "which are taken to repeat (1)", "morph targets, taken without them (1)",
        "colours of vertices, left out (1)"}) {
    EXPECT_EQ(notes_with(scene, words), 1u) << words;
  }
  EXPECT_EQ(scene.notes.size(), 13u);
}

/// A room of six squares as five nodes of one mesh and a lamp, in the way of a Cornell box.
struct Room {
  json document = json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "materials": [{"name": "wall", "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.7, 0.7, 1], "metallicFactor": 0}},
      {"name": "lamp", "emissiveFactor": [1, 0.8, 0.6], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]},
      {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 1}]}],
    "nodes": [{"name": "walls", "children": [2, 3, 4, 5, 6]},
      {"name": "lamp", "mesh": 1, "translation": [0, 0.499, 0], "rotation": [0.7071067811865476, 0, 0, 0.7071067811865476], "scale": [0.3, 0.3, 0.3]},
      {"mesh": 0, "name": "back", "translation": [0, 0, -0.5]},
      {"mesh": 0, "name": "left", "translation": [-0.5, 0, 0], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476]},
      {"mesh": 0, "name": "right", "translation": [0.5, 0, 0], "rotation": [0, -0.7071067811865476, 0, 0.7071067811865476]},
      {"mesh": 0, "name": "floor", "translation": [0, -0.5, 0], "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476]},
      {"mesh": 0, "name": "ceiling", "translation": [0, 0.5, 0], "rotation": [0.7071067811865476, 0, 0, 0.7071067811865476]}]})");
  std::string buffer;

  Room() {
    add_accessor(document, buffer, bytes_of<float>({-0.5, -0.5, 0, 0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, 0.5, 0}),
                 5126, "VEC3", 4);
    add_accessor(document, buffer, bytes_of<std::uint8_t>({0, 1, 2, 0, 2, 3}), 5121, "SCALAR", 6);
  }
};

TEST(GltfReader, ARoomIsTheSameAsGlbWithBinAndWithDataUris) {
  const Room room;
  const SceneInput binary = read(gltf_files::glb(room.document, room.buffer));
  json document = room.document;
  document["buffers"][0]["uri"] = "my%20room.bin";
  const SceneInput beside = read(document.dump(), {{"dir/my room.bin", room.buffer}});
  document["buffers"][0]["uri"] = gltf_files::data_uri(room.buffer);
  const SceneInput within = read(document.dump());

  ASSERT_EQ(binary.polygons.size(), 12u);
  EXPECT_EQ(binary.groups, (std::vector<std::string>{"back", "left", "right", "floor", "ceiling", "lamp"}));
  for (const InputPolygon& polygon : binary.polygons) {
    const Corners& c = polygon.corners;
    EXPECT_LT(glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), c[0] + c[1] + c[2]), 0);  // fronts look inwards
  }
  for (const SceneInput* const other : {&beside, &within}) {
    ASSERT_EQ(other->polygons.size(), binary.polygons.size());
    for (std::size_t k = 0; k < binary.polygons.size(); ++k) {
      EXPECT_EQ(other->polygons[k].corners, binary.polygons[k].corners);
      EXPECT_EQ(other->polygons[k].material, binary.polygons[k].material);
      EXPECT_EQ(other->polygons[k].group, binary.polygons[k].group);
    }
    EXPECT_EQ(other->groups, binary.groups);
    EXPECT_EQ(other->units, binary.units);
    EXPECT_EQ(other->notes, binary.notes);
    ASSERT_EQ(other->materials.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(other->materials[k].name, binary.materials[k].name);
      EXPECT_EQ(other->materials[k].rho, binary.materials[k].rho);
      EXPECT_EQ(other->materials[k].E, binary.materials[k].E);
      EXPECT_EQ(other->materials[k].sides, binary.materials[k].sides);
    }
  }
}

}  // namespace
}  // namespace fluxel::gltf_reader_test
