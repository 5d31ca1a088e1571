#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/gltf_files.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::gltf_rejects_test {
namespace {

using gltf_files::add_accessor;
using gltf_files::bytes_of;
using gltf_files::data_uri;
using gltf_files::error_of;
using gltf_files::json;
using gltf_files::Triangle;
using test_messages::expect_words;

/// The error of a triangle of which one thing, at a JSON pointer, is another.
std::string error_with(const std::string& pointer, const json& value) {
  Triangle triangle;
  triangle[pointer] = value;
  return error_of(triangle.text());
}

TEST(GltfRejects, TextsThatAreNoJson) {
  expect_words(error_of(""), {"dir/a.gltf:1: ", "not JSON at byte 0"});
  expect_words(error_of("{\"asset\":\n {\"version\": }}"), {"dir/a.gltf:2: ", "not JSON at byte 24"});
  expect_words(error_of("[1]"), {"dir/a.gltf: ", "no object"});
  expect_words(error_of("{\"asset\": \"\xFF\"}"), {"not JSON at byte"});
  expect_words(error_of("{\"asset\": 1e999}"), {"dir/a.gltf: ", "1e999"});
  const std::string half = Triangle().text();
  for (std::size_t k = 0; k < half.size(); k += 7) EXPECT_NE(error_of(half.substr(0, k)), "no error") << k;
}

TEST(GltfRejects, DeepJson) {
  std::string deep = R"({"asset": {"version": "2.0"}, "extras": )";
  for (int k = 0; k < 100'000; ++k) deep += R"([{"a":)";
  expect_words(error_of(deep), {"dir/a.gltf: ", "more than 64 deep"});
}

TEST(GltfRejects, OtherVersions) {
  expect_words(error_with("/asset/version", "1.0"), {"asset.version", "'1.0'", "only glTF 2"});
  expect_words(error_with("/asset", json::object()), {"asset.version", "is missing"});
}

TEST(GltfRejects, DamagedGlb) {
  const Triangle triangle;
  const std::string whole = gltf_files::glb(triangle.document, triangle.buffer);
  EXPECT_EQ(error_of(whole), "no error");
  for (std::size_t k = 4; k < whole.size(); ++k) EXPECT_NE(error_of(whole.substr(0, k)), "no error") << k;
  expect_words(error_of(whole.substr(0, 10)), {"header", "cut off"});
  expect_words(error_of(whole.substr(0, 100)), {"byte 8", "has 100"});
  const auto patched = [&](std::size_t at, std::uint32_t value) {
    return std::string(whole).replace(at, 4, bytes_of<std::uint32_t>({value}));
  };
  expect_words(error_of(patched(4, 1)), {"version 1", "only 2"});
  expect_words(error_of(patched(8, 4'000'000'000)), {"byte 8", "4000000000"});
  expect_words(error_of(patched(12, 4'294'967'295)), {"byte 12", "chunk of 4294967295 bytes", "cut off"});
  expect_words(error_of(patched(16, 7)), {"first chunk", "not JSON"});
  const std::size_t second = whole.size() - triangle.buffer.size() - 10;  // 42 bytes, padded to 44
  expect_words(error_of(patched(second, 1'000'000)), {"chunk of 1000000 bytes"});
  expect_words(error_of(patched(second + 4, 7)), {"buffers[0]", "no uri"});
  std::string broken = whole;
  broken[25] = '\x01';
  expect_words(error_of(broken), {"dir/a.gltf: ", "not JSON at byte 2"});
}

TEST(GltfRejects, BuffersThatAreNotThere) {
  expect_words(error_with("/buffers/0/byteLength", 1'000'000'000'000),
               {"buffers[0].byteLength", "1000000000000 bytes", "there are 42"});
  expect_words(error_with("/buffers/0/byteLength", -1), {"buffers[0].byteLength", "whole number"});
  expect_words(error_with("/buffers/0/uri", "gone.bin"), {"buffers[0].uri", "cannot find 'dir/gone.bin'"});
  Triangle triangle;
  triangle["/buffers"].push_back({{"byteLength", 4}});
  expect_words(error_of(triangle.text()), {"buffers[1]", "no uri"});
}

TEST(GltfRejects, UrisThatAreNoFilesOfTheFolder) {
  for (const char* const uri :
       {"../a.bin", "b/../../a.bin", "/etc/passwd", "http://example.org/a.bin", "file:///a.bin", "..%2Fa.bin",
        "%2e%2e/a.bin", "%2Fetc%2Fpasswd", "http%3A//example.org/a.bin", "..\\a.bin", "C:/a.bin"}) {
    expect_words(error_with("/buffers/0/uri", uri), {"buffers[0].uri", "not a file in the folder"});
  }
  for (const char* const uri : {"", "a%2", "a%zz.bin", "a%00.bin"})
    expect_words(error_with("/buffers/0/uri", uri), {"buffers[0].uri", "no file name"});
}

TEST(GltfRejects, DamagedDataUris) {
  const std::string good = data_uri(Triangle().buffer);
  EXPECT_EQ(error_with("/buffers/0/uri", good), "no error");
  expect_words(error_with("/buffers/0/uri", good + "AAA*"), {"buffers[0].uri", "no base64"});
  expect_words(error_with("/buffers/0/uri", good.substr(0, 46)),
               {"buffers[0].uri", "no base64"});  // 9 digits
  expect_words(error_with("/buffers/0/uri", good.substr(0, 45)), {"buffers[0].byteLength", "there are 6"});
  expect_words(error_with("/buffers/0/uri", "data:text/plain,hello"),
               {"buffers[0].uri", "not marked as base64"});
}

TEST(GltfRejects, AccessorsBeyondTheirBuffers) {
  expect_words(error_with("/accessors/0/count", 4),
               {"accessors[0]", "4 elements", "beyond bufferViews[0]", "36 bytes"});
  expect_words(error_with("/accessors/0/byteOffset", 4), {"accessors[0]", "from byte 4"});
  expect_words(error_with("/accessors/0/count", 9'007'199'254'740'992), {"accessors[0]", "beyond"});
  expect_words(error_with("/accessors/0/count", 1e18), {"accessors[0].count", "whole number"});
  expect_words(error_with("/accessors/1/count", 6), {"accessors[1]", "beyond bufferViews[1]"});
  expect_words(error_with("/bufferViews/0/byteOffset", 10),
               {"bufferViews[0]", "beyond buffers[0]", "42 bytes"});
  expect_words(error_with("/bufferViews/0/byteLength", 9'007'199'254'740'992),
               {"bufferViews[0]", "beyond buffers[0]"});
  expect_words(error_with("/bufferViews/0/byteStride", 8), {"accessors[0]", "12 bytes are 8 bytes apart"});
  expect_words(error_with("/bufferViews/0/buffer", 1),
               {"bufferViews[0].buffer", "1 is out of range", "buffers has 1"});
}

TEST(GltfRejects, AccessorsOfOtherTypes) {
  expect_words(error_with("/accessors/0/type", "VEC2"), {"accessors[0].type", "positions VEC3"});
  expect_words(error_with("/accessors/0/type", "MAT2"), {"accessors[0].type"});
  expect_words(error_with("/accessors/1/componentType", 5122), {"accessors[1]", "indices", "5123"});
  expect_words(error_with("/accessors/0/componentType", 5124), {"accessors[0].componentType", "5124"});
  expect_words(error_with("/accessors/0/componentType", 6), {"accessors[0].componentType", "6 is outside"});
  expect_words(error_with("/accessors/0/type", "VEC5"),
               {"accessors[0].type", "'VEC5' is unknown", "VEC2, VEC3"});
  expect_words(error_with("/accessors/0/type", "VEC2, VEC3"), {"accessors[0].type", "is unknown"});
  expect_words(error_with("/bufferViews/0/byteStride", 18),
               {"bufferViews[0].byteStride", "18 is no multiple of 4"});
  Triangle empty;
  empty["/accessors/0"].erase("bufferView");
  expect_words(error_of(empty.text()), {"accessors[0]", "no data"});
}

TEST(GltfRejects, BadSparseAccessors) {
  const auto error = [](const std::vector<std::uint8_t>& indices) {
    Triangle triangle;
    const std::size_t where = gltf_files::add_view(triangle.document, triangle.buffer, bytes_of(indices));
    triangle["/accessors/0/sparse"] = {{"count", indices.size()},
                                       {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                       {"values", {{"bufferView", 0}}}};
    return error_of(triangle.text());
  };
  EXPECT_EQ(error({0, 2}), "no error");
  expect_words(error({0, 3}), {"accessors[0].sparse.indices", "3 behind 0"});
  expect_words(error({1, 1}), {"accessors[0].sparse.indices", "1 behind 1"});
  expect_words(error({0, 1, 2, 3}), {"accessors[0].sparse.values", "beyond"});
  expect_words(error_with("/accessors/0/sparse", {{"count", 1}}),
               {"accessors[0].sparse.indices", "is missing"});
}

TEST(GltfRejects, IndicesOutOfRange) {
  Triangle triangle;
  triangle.primitive()["indices"] = add_accessor(
      triangle.document, triangle.buffer, bytes_of<std::uint32_t>({0, 1, 4'000'000'000}), 5125, "SCALAR", 3);
  expect_words(error_of(triangle.text()),
               {"accessors[2]", "4000000000 is out of range", "meshes[0].primitives[0] has 3 vertices"});
  expect_words(error_with("/nodes/0/mesh", 7), {"nodes[0].mesh", "7 is out of range", "meshes has 1"});
  expect_words(error_with("/nodes/0/mesh", 4'294'967'296), {"nodes[0].mesh", "out of range"});
  expect_words(error_with("/nodes/0/mesh", "0"), {"nodes[0].mesh", "whole number"});
  expect_words(error_with("/scene", 0), {"scene", "0 is out of range"});
  expect_words(error_with("/meshes/0/primitives/0/material", 0),
               {"meshes[0].primitives[0].material", "out of range"});
  expect_words(error_with("/meshes/0/primitives/0/attributes/POSITION", 9),
               {"meshes[0].primitives[0].attributes.POSITION"});
}

TEST(GltfRejects, MeshesThatAreNoTriangles) {
  expect_words(error_with("/meshes/0/primitives/0/attributes", {{"NORMAL", 0}}),
               {"meshes[0].primitives[0]", "no POSITION"});
  expect_words(error_with("/accessors/1/count", 2),
               {"meshes[0].primitives[0]", "2 vertices do not make triangles"});
  expect_words(error_with("/meshes/0/primitives/0/mode", 1), {"dir/a.gltf: ", "holds no triangle"});
  expect_words(error_of(R"({"asset": {"version": "2.0"}})"), {"dir/a.gltf: ", "holds no triangle"});
}

TEST(GltfRejects, TreesThatAreNone) {
  expect_words(error_with("/nodes/0/children", {0}), {"nodes[0]", "its own ancestor"});
  Triangle ring;
  ring["/nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {3}}}, {{"children", {1}}}};
  expect_words(error_of(ring.text()), {"nodes[", "its own ancestor"});
  Triangle shared;
  shared["/nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  expect_words(error_of(shared.text()), {"nodes[2]", "child of nodes[0] and of nodes[1]"});
  shared["/nodes/1"].erase("children");
  shared["/scenes"] = {{{"nodes", {2}}}};
  expect_words(error_of(shared.text()), {"scenes[0].nodes", "nodes[2] is a child of nodes[0]"});
  shared["/scenes"] = {{{"nodes", {0, 0}}}};
  expect_words(error_of(shared.text()), {"scenes[0].nodes", "nodes[0] twice"});
}

TEST(GltfRejects, NoDepthOfNodes) {
  Triangle deep;
  json& nodes = deep["/nodes"];
  nodes = json::array();
  for (int k = 0; k < 20'000; ++k) nodes.push_back({{"children", {k + 1}}, {"translation", {1, 0, 0}}});
  nodes.push_back({{"mesh", 0}});
  EXPECT_EQ(gltf_files::read(deep.text()).polygons[0].corners[0], glm::dvec3(20'000, 0, 0));
}

TEST(GltfRejects, PlacesThatAreNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    Triangle triangle;
    triangle.buffer.replace(16, 4, bytes_of<float>({bad}));  // vertex 1
    expect_words(error_of(triangle.text()), {"meshes[0].primitives[0]", "vertex 1", "not a finite number"});
  }
  expect_words(error_with("/nodes/0/translation", {1e300, 0, 0}),
               {"nodes[0].translation", "1e+300 is outside"});
  expect_words(error_with("/nodes/0/rotation", {0, 0, 0, 0}), {"nodes[0].rotation", "zero"});
  expect_words(error_with("/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1}),
               {"nodes[0].matrix", "not affine"});
  expect_words(error_with("/nodes/0/matrix", {1, 0, 0}), {"nodes[0].matrix", "16 numbers"});
  Triangle chain;
  chain["/nodes"] = {{{"scale", {1e12, 1, 1}}, {"children", {1}}}, {{"scale", {1e12, 1, 1}}, {"mesh", 0}}};
  expect_words(error_of(chain.text()), {"nodes[1]", "too large"});
}

TEST(GltfRejects, MaterialsOutOfRange) {
  const auto error = [](const char* material) {
    return error_with("/materials", json::array({json::parse(material)}));
  };
  expect_words(error(R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 1.2, 1, 1]}})"),
               {"materials[0].pbrMetallicRoughness.baseColorFactor", "1.2 is outside 0..1"});
  expect_words(error(R"({"pbrMetallicRoughness": {"baseColorFactor": [1, -0.1, 1, 1]}})"),
               {"-0.1 is outside 0..1"});
  expect_words(error(R"({"emissiveFactor": [0, 0, -1]})"), {"materials[0].emissiveFactor", "-1 is outside"});
  expect_words(error(R"({"emissiveFactor": [0, 1]})"), {"materials[0].emissiveFactor", "3 numbers"});
  expect_words(error(R"({"pbrMetallicRoughness": 3})"), {"materials[0].pbrMetallicRoughness", "an object"});
  expect_words(error(R"({"emissiveFactor": [1e15, 1, 1],
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 10}}})"),
               {"materials[0]", "emits too much"});
  expect_words(error_with("/materials", {1}), {"materials[0]", "an object"});
  expect_words(error_with("/cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 4}}}}}),
               {"cameras[0].perspective.yfov", "4 is outside"});
}

TEST(GltfRejects, CamerasAndSpotsWithoutValues) {
  const auto error = [](const char* camera, const char* light) {
    Triangle triangle;
    triangle["/nodes/0/camera"] = 0;
    triangle["/cameras"] = json::array({json::parse(camera)});
    triangle["/nodes/0/extensions/KHR_lights_punctual/light"] = 0;
    triangle["/extensions/KHR_lights_punctual/lights"] = json::array({json::parse(light)});
    return error_of(triangle.text());
  };
  const char* const ortho = R"({"type": "orthographic"})";
  EXPECT_EQ(
      error(R"({"type": "perspective", "perspective": {"yfov": 1}})", R"({"type": "spot", "spot": {}})"),
      "no error");
  expect_words(error(R"({"type": "wide"})", R"({"type": "point"})"),
               {"cameras[0].type", "'wide' is unknown"});
  expect_words(error(R"({"type": "perspective"})", R"({"type": "point"})"),
               {"cameras[0].perspective", "is missing"});
  expect_words(error(ortho, R"({"type": "spot"})"), {"lights[0].spot", "is missing"});
}

TEST(GltfRejects, ExtensionsThatItDoesNotKnow) {
  expect_words(error_with("/extensionsRequired",
                          {"KHR_texture_transform", "KHR_draco_mesh_compression", "EXT_meshopt_compression"}),
               {"extensionsRequired", "'KHR_draco_mesh_compression', 'EXT_meshopt_compression'"});
  EXPECT_EQ(error_with("/extensionsUsed", {"KHR_draco_mesh_compression"}), "no error");
}

TEST(GltfRejects, MoreCopiesThanMemoryHolds) {
  Triangle triangle;
  std::vector<std::uint8_t> indices;
  for (int k = 0; k < 30'000; ++k) indices.push_back(static_cast<std::uint8_t>(k % 3));
  triangle.primitive()["indices"] =
      add_accessor(triangle.document, triangle.buffer, bytes_of(indices), 5121, "SCALAR", 30'000);
  triangle["/nodes"] = json::array();
  for (int k = 0; k < 1000; ++k) triangle["/nodes"].push_back({{"mesh", 0}});  // 10 million triangles
  expect_words(error_of(triangle.text()), {"nodes[2", "makes more than 20", "used too often"});
  // A strip of 2^53 points that stand nowhere.
  triangle["/meshes/0/primitives"] = {{{"mode", 5}, {"attributes", {{"POSITION", 0}}}}};
  const std::size_t where =
      gltf_files::add_view(triangle.document, triangle.buffer, bytes_of<std::uint8_t>({0}));
  triangle["/accessors/0"] = {{"componentType", 5126},
                              {"type", "VEC3"},
                              {"count", 9'007'199'254'740'992},
                              {"sparse",
                               {{"count", 1},
                                {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                {"values", {{"bufferView", 0}}}}}};
  expect_words(error_of(triangle.text()), {"nodes[0]", "used too often"});
}

}  // namespace
}  // namespace fluxel::gltf_rejects_test
