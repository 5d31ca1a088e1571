#include "scene/readers/ply_reader.hpp"
#include "core/options.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/srgb.hpp"
#include "tests/unit/file_bytes.hpp"
#include "tests/unit/messages.hpp"
#include "tests/unit/read_bytes.hpp"

namespace fluxel::ply_reader_test {
namespace {

using test_messages::expect_words;

SceneInput read(const std::string& bytes) { return test_readers::read_bytes(read_ply, "dir/a.ply", bytes); }
std::string error_of(const std::string& bytes) {
  return test_readers::error_of(read_ply, "dir/a.ply", bytes);
}

constexpr const char* kXyz = "property float x\nproperty float y\nproperty float z\n";
constexpr const char* kList = "property list uchar int vertex_indices\n";
constexpr const char* kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string ascii(const std::string& of_vertex, const std::string& of_face, const std::string& body,
                  int faces = 1) {
  return "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\n" + of_vertex + "element face " +
         std::to_string(faces) + "\n" + of_face + "end_header\n" + body;
}

/// A number as a file of other endianness has it, or of this one.
template <class Value>
std::string raw(Value value, bool big) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(Value));
  if (big) std::ranges::reverse(bytes);  // the machines that test are little
  return bytes;
}

std::string binary_triangle(bool big, std::int32_t length = 3, std::uint16_t last = 2, double z = 0.125) {
  std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                      "_endian 1.0\nelement vertex 3\nproperty double z\nproperty short x\nproperty uchar y\n"
                      "element face 1\nproperty list int ushort vertex_index\nend_header\n";
  bytes += raw(z, big) + raw<std::int16_t>(-300, big) + raw<std::uint8_t>(0, big);
  bytes += raw(0.25, big) + raw<std::int16_t>(1, big) + raw<std::uint8_t>(0, big);
  bytes += raw(0.5, big) + raw<std::int16_t>(0, big) + raw<std::uint8_t>(200, big);
  return bytes + raw(length, big) + raw<std::uint16_t>(0, big) + raw<std::uint16_t>(1, big) + raw(last, big);
}

TEST(PlyReader, ReadsAText) {
  const SceneInput scene = read(ascii(kXyz, kList, std::string(kSquare) + "4 0 1 2 3\n\n3 0 1 3", 2));
  EXPECT_EQ(scene.name, "a");
  ASSERT_EQ(scene.polygons.size(), 2u);
  EXPECT_EQ(scene.polygons[0].corners, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(scene.polygons[1].corners, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(scene.groups, std::vector<std::string>{"a"});
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "default");
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.5));
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"dir/a.ply", "no colours", "2 faces", "'default'", "0.5"});
}

TEST(PlyReader, ReadsBinaryFilesOfEitherEndianness) {
  for (const bool big : {false, true}) {
    const SceneInput scene = read(binary_triangle(big));
    ASSERT_EQ(scene.polygons.size(), 1u);
    EXPECT_EQ(scene.polygons[0].corners,
              (std::vector<glm::dvec3>{{-300, 0, 0.125}, {1, 0, 0.25}, {0, 200, 0.5}}))
        << big;
  }
}

TEST(PlyReader, ReadsASolutionAsGeometry) {
  const std::filesystem::path file =
      std::filesystem::path(FLUXEL_SOURCE_DIR) / "tests/fuzz/corpus/element_file/two_sided.ply";
  const SceneInput scene = read(bytes_of(file));
  EXPECT_EQ(scene.polygons.size(), 2u);
  expect_words(scene.notes.at(1), {"'radiosity_r' of face", "'patch' of face"});
}

TEST(PlyReader, TakesAllTypesByBothNames) {
  for (const char* const type : {"char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16",
                                 "int", "int32", "uint", "uint32", "float", "float32", "double", "float64"}) {
    const std::string x = fmt::format("property {} x\nproperty float y\nproperty float z\n", type);
    EXPECT_EQ(read(ascii(x, kList, std::string(kSquare) + "3 0 1 2\n")).polygons.size(), 1u) << type;
  }
}

TEST(PlyReader, TakesCrlfAndFacesBeforeVertices) {
  const SceneInput scene = read(
      "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement face 1\r\nproperty list uchar uint vertex_index\r\n"
      "element vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nend_header\r\n"
      "3 2 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n");
  EXPECT_EQ(scene.polygons[0].corners, (std::vector<glm::dvec3>{{0, 1, 0}, {1, 0, 0}, {0, 0, 0}}));
  expect_words(error_of("ply\r\nformat ascii 1.1\r\n"), {"a.ply:2:", "'1.1'"});
  std::string binary = binary_triangle(false);
  for (std::size_t end = binary.find('\n'), lines = 0; lines < 8; ++lines, end = binary.find('\n', end + 2))
    binary.insert(end, 1, '\r');
  EXPECT_EQ(read(binary).polygons[0].corners[0], glm::dvec3(-300, 0, 0.125));
}

TEST(PlyReader, ColoursOfEightBitsAreSrgb) {
  const SceneInput scene =
      read(ascii(kXyz, std::string(kList) + "property uchar red\nproperty uchar green\nproperty uchar blue\n",
                 std::string(kSquare) + "3 0 1 2 188 188 64\n3 0 2 3 188 188 64\n3 0 1 3 255 0 0\n", 3));
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "colour 188 188 64");
  // IEC 61966-2-1: ((188/255 + 0.055) / 1.055)^2.4 and ((64/255 + 0.055) / 1.055)^2.4, by hand.
  EXPECT_NEAR(scene.materials[0].rho.r, 0.502886, 1e-6);
  EXPECT_NEAR(scene.materials[0].rho.b, 0.051269, 1e-6);
  EXPECT_EQ(scene.materials[1].rho, Rgb(1, 0, 0));
  EXPECT_EQ(index(scene.polygons[1].material), 0u);
  EXPECT_EQ(index(scene.polygons[2].material), 1u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(PlyReader, FloatColoursAreLinearAndKeepTheirValue) {
  const SceneInput scene = read(
      ascii(kXyz, std::string(kList) + "property double red\nproperty double green\nproperty double blue\n",
            std::string(kSquare) + "3 0 1 2 0.5 0.25 0\n"));
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.5, 0.25, 0));
  EXPECT_EQ(scene.materials[0].name, "colour 188 137 0");
}

TEST(PlyReader, FacesOfNearlyOneColourShareAMaterialOfTheirMean) {
  const SceneInput scene = read(
      ascii(kXyz, std::string(kList) + "property double red\nproperty double green\nproperty double blue\n",
            std::string(kSquare) + "3 0 1 2 0.5 0.5 0.5\n3 0 2 3 0.501 0.5 0.5\n", 2));
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.materials[0].rho.r, 0.5005);
}

TEST(PlyReader, VertexColoursAreAveragedInLinearLightAndFaceColoursWin) {
  const std::string coloured =
      std::string(kXyz) + "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string vertices = "0 0 0 255 0 0\n1 0 0 0 0 0\n1 1 0 255 0 0\n0 1 0 0 0 0\n";
  const SceneInput by_vertex = read(ascii(coloured, kList, vertices + "4 0 1 2 3\n"));
  EXPECT_EQ(by_vertex.materials[0].rho, Rgb(0.5, 0, 0));
  const SceneInput by_face = read(
      ascii(coloured, std::string(kList) + "property float red\nproperty float green\nproperty float blue\n",
            vertices + "4 0 1 2 3 0 1 0\n"));
  EXPECT_EQ(by_face.materials[0].rho, Rgb(0, 1, 0));
}

TEST(PlyReader, PassesOverOtherElementsAndPropertiesWithANote) {
  const SceneInput scene = read(
      "ply\nformat ascii 1.0\nelement camera 1\nproperty float fov\nproperty list uchar float more\n"
      "element vertex 3\n" +
      std::string(kXyz) + "property float nx\nproperty ushort red\nproperty ushort green\n" +
      "property ushort blue\nelement face 1\nproperty uint patch\n" + kList +
      "element nothing 1000000000000\nend_header\n0.5 2 1 2\n0 0 0 9 1 1 1\n1 0 0 9 1 1 1\n"
      "0 1 0 9 1 1 1\n7 3 0 1 2\n");
  ASSERT_EQ(scene.polygons.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "default");
  ASSERT_EQ(scene.notes.size(), 2u);
  expect_words(scene.notes[1],
               {"ignored", "'nx' of vertex", "'red' of vertex", "'patch' of face", "element 'camera'"});
}

TEST(PlyReader, ReadsAFaceOfManyCorners) {
  std::string face = "4096";
  for (int i = 0; i < 4096; ++i) face += i % 2 ? " 1" : " 0";
  const std::string list = "property list int int vertex_indices\n";
  EXPECT_EQ(read(ascii(kXyz, list, kSquare + face)).polygons[0].corners.size(), 4096u);
  expect_words(error_of(ascii(kXyz, list, std::string(kSquare) + "4097 0 1 2\n")),
               {"a.ply:15:", "4097 corners", "4096"});
}

TEST(PlyReader, RefusesBadHeaders) {
  const std::string start = "ply\nformat ascii 1.0\n";
  expect_words(error_of(""), {"dir/a.ply:1:", "ends too early"});
  expect_words(error_of("plyx\n"), {"a.ply:1:", "no PLY file"});
  expect_words(error_of("ply\n"), {"a.ply:2:", "ends too early", "end_header"});
  expect_words(error_of("ply\nformat binary 1.0\n"), {"a.ply:2:", "unknown format 'binary'", "ascii"});
  expect_words(error_of("ply\nformat ascii 2.0\n"), {"a.ply:2:", "version '2.0'"});
  expect_words(error_of("ply\nend_header\n"), {"says no format"});
  expect_words(error_of(start + "elements vertex 3\n"), {"a.ply:3:", "unknown keyword 'elements'"});
  expect_words(error_of(start + "element vertex -3\n"), {"a.ply:3:", "'-3'", "not a whole number"});
  expect_words(error_of(start + "element vertex 99999999999999999999999\n"),
               {"a.ply:3:", "not a whole number"});
  expect_words(error_of(start + "element a 1\nelement a 1\n"), {"a.ply:4:", "'a' stands twice"});
  expect_words(error_of(start + "property float x\n"), {"a.ply:3:", "before any element"});
  expect_words(error_of(start + "element a 1\nproperty real x\n"), {"a.ply:4:", "unknown type 'real'"});
  expect_words(error_of(start + "element a 1\nproperty float\n"), {"a.ply:4:", "no name"});
  expect_words(error_of(start + "element a 1\nproperty list float int x\n"),
               {"a.ply:4:", "length of a list"});
  expect_words(error_of(start + "comment \x01\n"), {"a.ply:3:", "binary data"});
}

TEST(PlyReader, RefusesMoreItemsThanTheFileMayHold) {
  for (const char* const format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string start = std::string("ply\nformat ") + format + " 1.0\n";
    expect_words(error_of(start + "element vertex 1000000000000\n" + kXyz + "element face 1\n" + kList +
                          "end_header\n1 2 3\n"),
                 {"a.ply:3:", "too short for 1000000000000 items of element 'vertex'", "6 bytes"});
  }
}

TEST(PlyReader, RefusesWhatIsNoSurface) {
  const std::string face = std::string(kSquare) + "3 0 1 2\n";
  expect_words(error_of(ascii(kXyz, kList, kSquare, 0)), {"holds no face", "cloud of points"});
  expect_words(error_of("ply\nformat ascii 1.0\nelement vertex 0\n" + std::string(kXyz) +
                        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n1 1\n"),
               {"holds no face", "strips", "save it with faces"});
  expect_words(error_of("ply\nformat ascii 1.0\nend_header\n"), {"no element 'vertex'"});
  expect_words(error_of(ascii("property float x\nproperty float y\n", kList, face)), {"no property 'z'"});
  expect_words(error_of(ascii(kXyz, "property list uchar float vertex_indices\n", face)),
               {"no list 'vertex_indices'"});
  expect_words(error_of(ascii(kXyz, "property int vertex_indices\n", face)), {"no list 'vertex_indices'"});
}

TEST(PlyReader, RefusesBadTexts) {
  const std::string square = kSquare;
  const auto error_with = [&](const std::string& body) { return error_of(ascii(kXyz, kList, body)); };
  expect_words(error_with("0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n"), {"a.ply:12:", "z", "too few numbers"});
  expect_words(error_with("0 0 0\n1 0 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), {"a.ply:12:", "one number too many"});
  expect_words(error_with("0 0 0\n1 0 0\n1 1 0\n0 1 0         "), {"a.ply:14:", "ends before its last item"});
  expect_words(error_with(square + "3 0 1\n"), {"a.ply:15:", "vertex index", "too few numbers"});
  expect_words(error_with(square + "3 0 1 4\n"), {"a.ply:15:", "index 4 is out of range", "4 vertices"});
  expect_words(error_with(square + "3 0 1 -1\n"), {"a.ply:15:", "index -1 is out of range"});
  expect_words(error_with(square + "3 0 1 1.5\n"), {"a.ply:15:", "'1.5' is not a whole number"});
  expect_words(error_with(square + "2 0 1\n"), {"a.ply:15:", "at least 3 corners", "has 2"});
  expect_words(error_with(square + "-1 0 1\n"), {"a.ply:15:", "length -1"});
  expect_words(error_with(square + "2147483648 0 1\n"), {"a.ply:15:", "2147483648 corners"});
  expect_words(error_with(square + "1e300 0 1\n"), {"a.ply:15:", "length 1e+300"});
  expect_words(error_with("0 0 nan\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), {"a.ply:11:", "'nan'", "not a finite"});
  expect_words(error_with("0 0 1e16\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), {"a.ply:11:", "too large"});
  expect_words(error_with("0 0 z\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), {"a.ply:11:", "'z'", "not a number"});
  const std::string red = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  expect_words(error_of(ascii(kXyz, kList + red, square + "3 0 1 2 0 256 0\n")),
               {"a.ply:18:", "colour 256", "0..255"});
  const std::string linear = "property float red\nproperty float green\nproperty float blue\n";
  expect_words(error_of(ascii(kXyz, kList + linear, square + "3 0 1 2 0 1.5 0\n")),
               {"a.ply:18:", "1.5", "0..1"});
}

TEST(PlyReader, RefusesBadBinaryFiles) {
  const std::string whole = binary_triangle(false);
  expect_words(error_of(whole.substr(0, whole.size() - 1)),
               {"dir/a.ply", "byte " + std::to_string(whole.size() - 2), "vertex index", "the file ends"});
  expect_words(error_of(whole.substr(0, whole.size() - 7)),
               {"a.ply:7:", "too short for 1 items of element 'face'"});
  expect_words(error_of(binary_triangle(false, 2147483647)), {"byte", "2147483647 corners"});
  expect_words(error_of(binary_triangle(true, -2147483647)), {"byte", "length -2147483647"});
  expect_words(error_of(binary_triangle(true, 3, 3)), {"byte", "index 3 is out of range"});
  expect_words(error_of(binary_triangle(false, 3, 2, std::numeric_limits<double>::quiet_NaN())),
               {"byte", "nan", "not finite"});
  expect_words(error_of(binary_triangle(true, 3, 2, std::numeric_limits<double>::infinity())),
               {"byte", "inf", "not finite"});
}

TEST(Srgb, DecodesWhatItEncodes) {
  for (int value = 0; value < 256; ++value) {
    const auto byte = static_cast<std::uint8_t>(value);
    EXPECT_EQ(encode_srgb(decode_srgb(byte)), byte);
  }
}

}  // namespace
}  // namespace fluxel::ply_reader_test
