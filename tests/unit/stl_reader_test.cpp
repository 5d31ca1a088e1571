#include "scene/readers/stl_reader.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "tests/unit/messages.hpp"
#include "tests/unit/read_bytes.hpp"

namespace fluxel::stl_reader_test {
namespace {

using test_messages::expect_words;

SceneInput read(const std::string& bytes) {
  return test_readers::read_bytes(read_stl, "dir/part.stl", bytes);
}
std::string error_of(const std::string& bytes) {
  return test_readers::error_of(read_stl, "dir/part.stl", bytes);
}

std::string facet_text(const std::string& normal, const std::string& first = "0 0 0") {
  return "  facet normal " + normal + "\n    outer loop\n      vertex " + first +
         "\n      vertex 1 0 0\n      vertex 0 1 0\n    endloop\n  endfacet\n";
}

std::string solid_text(const std::string& facets) { return "solid a\n" + facets + "endsolid a\n"; }

template <class Value>
void append(std::string& bytes, Value value) {  // little endian, as the machines are that test
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(Value));
}

void append_facet(std::string& bytes, float normal_z, float first_x = 0, std::uint16_t attribute = 0) {
  for (const float value : {0.f, 0.f, normal_z, first_x, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    append(bytes, value);
  append(bytes, attribute);
}

std::string binary_start(std::string header, std::uint32_t count) {
  header.resize(80, '\0');
  append(header, count);
  return header;
}

TEST(StlReader, ReadsFacetsAndSolidsOfAText) {
  const SceneInput scene =
      read("solid left wall\n" + facet_text("0 0 1", "0.1 -1e-3 +2.5") + "endsolid left wall\n\r\nSOLID\n" +
           facet_text("0 0 1") + facet_text("0 0 0") + "EndSolid");
  EXPECT_EQ(scene.name, "part");
  EXPECT_EQ(scene.groups, (std::vector<std::string>{"left wall", "part"}));
  ASSERT_EQ(scene.polygons.size(), 3u);
  EXPECT_EQ(scene.polygons[0].corners, (std::vector<glm::dvec3>{{0.1, -1e-3, 2.5}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(index(scene.polygons[0].group), 0u);
  EXPECT_EQ(index(scene.polygons[2].group), 1u);
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "default");
  EXPECT_EQ(scene.materials[0].rho, Rgb(0.5));
  ASSERT_EQ(scene.notes.size(), 1u);
  expect_words(scene.notes[0], {"dir/part.stl", "no materials", "3 facets", "'default'", "0.5"});
}

TEST(StlReader, NotesNormalsThatContradictTheCorners) {
  const SceneInput scene = read(solid_text(facet_text("0 0 1") + facet_text("0 0 -1") +
                                           facet_text("nan -NaN(ind) 0") + facet_text("0 0 0")));
  EXPECT_GT(test_readers::area_vector(scene.polygons[1]).z, 0);  // by the corners, not by the normal
  ASSERT_EQ(scene.notes.size(), 2u);
  expect_words(scene.notes[1], {"normals of 1 of 4 facets"});
}

TEST(StlReader, ReadsABinaryFile) {
  std::string bytes = binary_start("made by hand", 2);
  append_facet(bytes, 1, 0.25f);
  append_facet(bytes, -1, 0, 0x8000);
  const SceneInput scene = read(bytes);
  EXPECT_EQ(scene.groups, std::vector<std::string>{"made by hand"});
  ASSERT_EQ(scene.polygons.size(), 2u);
  EXPECT_EQ(scene.polygons[0].corners, (std::vector<glm::dvec3>{{0.25, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  ASSERT_EQ(scene.notes.size(), 3u);
  expect_words(scene.notes[1], {"normals of 1 of 2 facets"});
  expect_words(scene.notes[2], {"attributes", "1 of 2 facets", "ignored"});
}

TEST(StlReader, ATextMayBeginWithAByteOrderMark) {
  EXPECT_EQ(read("\xEF\xBB\xBF" + solid_text(facet_text("0 0 1"))).groups, std::vector<std::string>{"a"});
}

TEST(StlReader, ABinaryFileMayBeginWithSolid) {
  std::string bytes = binary_start("solid of a program", 1);
  append_facet(bytes, 1);
  EXPECT_EQ(read(bytes).groups, std::vector<std::string>{"of a program"});
}

TEST(StlReader, ABinaryHeaderWithoutANameGivesTheFiles) {
  std::string bytes = binary_start("", 1);
  append_facet(bytes, 1);
  EXPECT_EQ(read(bytes).groups, std::vector<std::string>{"part"});
}

TEST(StlReader, RefusesDamagedBinaryFiles) {
  std::string whole = binary_start("solid x", 2);
  append_facet(whole, 1);
  append_facet(whole, 1);
  for (const std::size_t bytes : {183u, 134u, 84u})
    expect_words(error_of(whole.substr(0, bytes)),
                 {"dir/part.stl", "byte 80", "2 triangles", "184 bytes", std::to_string(bytes)});
  expect_words(error_of(whole + "x"), {"184 bytes, this one has 185"});
  expect_words(error_of(binary_start("", 4294967295u)), {"4294967295 triangles", "214748364834 bytes"});
  expect_words(error_of(binary_start("", 0)), {"holds no facet"});
  expect_words(error_of(std::string("\x01\x02\0", 3)), {"no STL file"});
  expect_words(error_of(""), {"no STL file"});

  std::string infinite = binary_start("", 1);
  append_facet(infinite, 1, std::numeric_limits<float>::infinity());
  expect_words(error_of(infinite), {"byte 96", "inf", "not finite"});
  std::string nan = binary_start("", 1);
  append_facet(nan, 1, std::numeric_limits<float>::quiet_NaN());
  expect_words(error_of(nan), {"byte 96", "nan", "not finite"});
}

TEST(StlReader, RefusesDamagedTexts) {
  const std::string facet = facet_text("0 0 1");
  expect_words(error_of("solid a\nendsolid a\n"), {"dir/part.stl", "holds no facet"});
  expect_words(error_of("solid a\n" + facet),
               {"part.stl:8:", "ends where 'facet' or 'endsolid' must", "cut off"});
  expect_words(error_of(solid_text(facet_text("0 0 1", "0 0"))), {"part.stl:5:", "'vertex'", "not a number"});
  expect_words(error_of(solid_text(facet_text("0 0 1", "0 0 0 0"))), {"part.stl:4:", "'vertex'", "not '0'"});
  expect_words(error_of(solid_text(facet_text("0 0 1", "0 nan 0"))),
               {"part.stl:4:", "'nan'", "not a finite"});
  expect_words(error_of(solid_text(facet_text("0 0 1", "0 0 1e16"))), {"part.stl:4:", "'1e16'", "too large"});
  expect_words(error_of(solid_text(facet_text("0 zero 1"))), {"part.stl:2:", "normal", "'zero'"});
  expect_words(error_of(solid_text("facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 endloop\n")),
               {"part.stl:2:", "'vertex' must stand here, not 'endloop'"});
  expect_words(error_of(solid_text(facet) + "more"), {"part.stl:10:", "'solid'", "'more'"});
  expect_words(error_of("solid a\x01\n" + facet), {"part.stl:1:", "binary"});
}

}  // namespace
}  // namespace fluxel::stl_reader_test
