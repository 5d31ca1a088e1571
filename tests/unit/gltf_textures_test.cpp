#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <limits>
#include <numbers>

#include "core/options.hpp"
#include "tests/unit/gltf_files.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::gltf_textures_test {
namespace {

using gltf_files::add_accessor;
using gltf_files::bytes_of;
using gltf_files::error_of;
using gltf_files::json;
using gltf_files::read;
using gltf_files::Triangle;
using test_messages::expect_words;

/// Two by two pixels, whose values mean the same in sRGB and in linear light: red, green; blue, white.
std::string four_pixels() {
  const std::array<std::uint8_t, 12> pixels{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = 2;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  EXPECT_NE(png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), 0, nullptr), 0);
  std::string bytes(size, '\0');
  EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr), 0);
  bytes.resize(size);
  return bytes;
}

/// A triangle of texture coordinates with its right angle at (u, v), two sides of the length.
std::string corner_at(float u, float v, float length = 0.2f) {
  return bytes_of<float>({u, v, u + length, v, u, v + length});
}

/// The triangle with four_pixels as "dir/p.png" and a material that has it.
struct Textured : Triangle {
  explicit Textured(const std::string& coordinates) {
    const std::size_t accessor = add_accessor(document, buffer, coordinates, 5126, "VEC2", 3);
    document.update(json::parse(R"({"images": [{"uri": "p.png"}], "textures": [{"source": 0}],
      "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 0,
                                              "baseColorTexture": {"index": 0}}}]})"));
    primitive()["attributes"]["TEXCOORD_0"] = accessor;
    primitive()["material"] = 0;
  }

  [[nodiscard]] SceneInput scene() const { return read(text(), {{"dir/p.png", four_pixels()}}); }
  [[nodiscard]] std::string error() const { return error_of(text(), {{"dir/p.png", four_pixels()}}); }
};

Rgb rho_at(float u, float v) { return Textured(corner_at(u, v)).scene().face_rho.at(0); }

TEST(GltfTextures, TheImageIsUprightAndRepeats) {
  // (0, 0) is the upper left corner of the image.
  EXPECT_EQ(rho_at(0.1f, 0.1f), Rgb(0.5, 0, 0));
  EXPECT_EQ(rho_at(0.6f, 0.1f), Rgb(0, 0.25, 0));
  EXPECT_EQ(rho_at(0.1f, 0.6f), Rgb(0, 0, 1));
  EXPECT_EQ(rho_at(0.6f, 0.6f), Rgb(0.5, 0.25, 1));
  EXPECT_EQ(rho_at(-0.9f, 3.1f), Rgb(0.5, 0, 0));
}

TEST(GltfTextures, MaterialsHaveTheMeanOfTheirTrianglesByArea) {
  Textured triangle(corner_at(0.1f, 0.1f, 0.2f));  // red
  const std::size_t green =
      add_accessor(triangle.document, triangle.buffer, corner_at(0.6f, 0.1f, 0.1f), 5126, "VEC2", 3);
  json second = triangle.primitive(), plain = triangle.primitive();
  second["attributes"]["TEXCOORD_0"] = green;
  plain["material"] = 1;
  triangle["/meshes"].push_back({{"primitives", {second, plain}}});
  triangle["/nodes"].push_back({{"mesh", 1}});
  triangle["/nodes"].push_back({{"mesh", 1}});
  triangle["/materials"].push_back(json::parse(
      R"({"pbrMetallicRoughness": {"baseColorFactor": [0.3, 0.3, 0.3, 1], "metallicFactor": 0}})"));
  const SceneInput scene = triangle.scene();
  const Rgb red(0.5, 0, 0), grey(0.3), dark_green(0, 0.25, 0);
  EXPECT_EQ(scene.face_rho, (std::vector<Rgb>{red, dark_green, grey, dark_green, grey}));
  // Three triangles of one area in space, whatever theirs in the image.
  EXPECT_NEAR(scene.materials[0].rho.r, 0.5 / 3, 1e-6);
  EXPECT_NEAR(scene.materials[0].rho.g, 0.25 * 2 / 3, 1e-6);
  EXPECT_TRUE(scene.materials[0].textured);
  EXPECT_FALSE(scene.materials[1].textured);
  EXPECT_EQ(scene.materials[0].rho.b, 0);
}

TEST(GltfTextures, WithoutCoordinatesTheMeanOfTheImageCounts) {
  Textured triangle(corner_at(0.1f, 0.1f));
  triangle.primitive()["attributes"].erase("TEXCOORD_0");
  const SceneInput scene = triangle.scene();
  EXPECT_EQ(scene.face_rho, std::vector<Rgb>{Rgb(0.25, 0.125, 0.5)});
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.25, 0.125, 0.5));
}

TEST(GltfTextures, TransformsScaleThenTurnThenMove) {
  const auto rho = [](const char* transform, float u, float v) {
    Textured triangle(corner_at(u, v, 0.02f));
    triangle["/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform"] =
        json::parse(transform);
    return triangle.scene().face_rho.at(0);
  };
  const Rgb red(0.5, 0, 0), green(0, 0.25, 0), blue(0, 0, 1);
  EXPECT_EQ(rho(R"({"offset": [0.5, 0]})", 0.1f, 0.1f), green);
  EXPECT_EQ(rho(R"({"scale": [1, 3]})", 0.1f, 0.2f), blue);  // v = 0.6
  // A quarter turn counter-clockwise, as one sees the image: right becomes up, (0.3, 0.1) -> (0.1, -0.3).
  EXPECT_EQ(rho(R"({"rotation": 1.5707963267948966})", 0.3f, 0.1f), blue);
  // (0.2, 0.1) -> (0.6, 0.1) -> (0.1, -0.6) -> (0.6, 0.2).
  EXPECT_EQ(rho(R"({"scale": [3, 1], "rotation": 1.5707963267948966, "offset": [0.5, 0.8]})", 0.2f, 0.1f),
            green);
  Textured other(corner_at(0.1f, 0.1f));
  other.primitive()["attributes"]["TEXCOORD_1"] =
      add_accessor(other.document, other.buffer, corner_at(0.1f, 0.6f), 5126, "VEC2", 3);
  EXPECT_EQ(other.scene().face_rho.at(0), red);
  other["/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/texCoord"] = 1;
  EXPECT_EQ(other.scene().face_rho.at(0), blue);
}

TEST(GltfTextures, ImagesMayStandWithinTheFile) {
  Textured triangle(corner_at(0.1f, 0.1f));
  triangle["/images/0/uri"] = "data:image/png;base64," + gltf_files::base64(four_pixels());
  EXPECT_EQ(read(triangle.text()).face_rho.at(0), Rgb(0.5, 0, 0));
  triangle["/images/0"] = {
      {"mimeType", "image/png"},
      {"bufferView", gltf_files::add_view(triangle.document, triangle.buffer, four_pixels())}};
  EXPECT_EQ(read(gltf_files::glb(triangle.document, triangle.buffer)).face_rho.at(0), Rgb(0.5, 0, 0));
}

TEST(GltfTextures, EmissionIsMultipliedByItsMean) {
  Textured triangle(corner_at(0.6f, 0.6f));  // white
  triangle["/materials"] = json::parse(R"([{"emissiveFactor": [2, 2, 2], "emissiveTexture": {"index": 0}}])");
  EXPECT_EQ(triangle.scene().materials[0].E, Rgb(2 * std::numbers::pi));
  EXPECT_TRUE(triangle.scene().face_rho.empty());
  triangle.primitive()["attributes"].erase("TEXCOORD_0");
  EXPECT_EQ(triangle.scene().materials[0].E, Rgb(std::numbers::pi));
}

TEST(GltfTextures, RefusesBadCoordinatesAndImages) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect_words(Textured(bytes_of<float>({0, 0, 1, nan, 0, 1})).error(),
               {"meshes[0].primitives[0]", "TEXCOORD_0", "not a finite number"});
  expect_words(Textured(bytes_of<float>({0, 0, 1e9f, 0, 0, 1})).error(),
               {"TEXCOORD_0", "not a finite number"});
  Textured longer(corner_at(0, 0));
  longer["/accessors/2/count"] = 2;
  expect_words(longer.error(), {"meshes[0].primitives[0]", "TEXCOORD_0 and POSITION differ"});
  expect_words(error_of(Textured(corner_at(0, 0)).text()), {"images[0].uri", "cannot find 'dir/p.png'"});
  expect_words(error_of(Textured(corner_at(0, 0)).text(), {{"dir/p.png", "no image"}}),
               {"dir/a.gltf: p.png"});
  Textured none(corner_at(0, 0));
  none["/images/0"] = json::object();
  expect_words(none.error(), {"images[0]", "neither uri nor bufferView"});
  none["/images/0"] = {{"bufferView", 9}};
  expect_words(none.error(), {"images[0].bufferView", "9 is out of range"});
  none["/images/0"] = {{"uri", "p.png"}};
  none["/textures/0"] = json::object();
  expect_words(none.error(), {"textures[0]", "names no image"});
}

}  // namespace
}  // namespace fluxel::gltf_textures_test
