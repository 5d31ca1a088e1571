#include "output/elements/element_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"
#include "core/version.hpp"
#include "tests/unit/file_bytes.hpp"

namespace fluxel {
namespace {

namespace fs = std::filesystem;

/// What a file's bytes are refused with; empty where they are taken.
std::string refusal(const std::string& bytes) {
  try {
    static_cast<void>(element_file_of_bytes("a.ply", bytes));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string bytes, const std::string& old, const std::string& by) {
  const std::size_t at = bytes.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return bytes.replace(at, old.size(), by);
}

/// A square and a triangle on its side x = 1, far from the origin, with three layers.
class ElementFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder =
        fs::path(testing::TempDir()) /
        ("fluxel_elements_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    const glm::dvec3 origin(4e6 + 1.0 / 3, -2, 0.5);
    const auto at = [&](double x, double y) { return origin + glm::dvec3(x, y, 0); };
    elements.outlines = {{{at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, 4}, {{at(1, 0), at(2, 0), at(1, 1)}, 3}};
    elements.patches = {PatchId{7}, PatchId{9}};
    for (int layer = 0; layer < 3; ++layer) values.push_back({Rgb(layer, 0.5, 2), Rgb(-3, layer, 0.25)});
    layers = {{"radiosity", values[0]}, {"error", values[1]}, {"radiosity_back", values[2]}};
    write_element_file(folder / "a.ply", elements, layers);
    bytes = bytes_of(folder / "a.ply");
  }
  void TearDown() override { fs::remove_all(folder); }

  FileElements elements;
  std::vector<std::vector<Rgb>> values;
  std::vector<ElementLayer> layers;
  fs::path folder;
  std::string bytes;
};

TEST_F(ElementFiles, AreReadAsTheyWereWritten) {
  const ElementFile file = read_element_file(folder / "a.ply");
  ASSERT_EQ(file.elements.outlines.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(file.elements.outlines[i].corners, elements.outlines[i].corners);
    EXPECT_EQ(file.elements.outlines[i].corner, elements.outlines[i].corner);
  }
  EXPECT_EQ(file.elements.patches, elements.patches);
  ASSERT_EQ(file.layers.size(), 3u);
  for (const ElementLayer& layer : layers)
    EXPECT_TRUE(std::ranges::equal(file.layers.at(layer.name), layer.values)) << layer.name;
}

TEST_F(ElementFiles, AreWrittenAgainWithTheSameBytes) {
  const ElementFile file = read_element_file(folder / "a.ply");
  write_element_file(folder / "b.ply", file.elements, layers);
  EXPECT_EQ(bytes_of(folder / "b.ply"), bytes);
}

TEST_F(ElementFiles, OfAnotherVersionAreRead) {
  EXPECT_EQ(refusal(replaced(bytes, version(), "0.0.0-of-long-ago")), "");
}

TEST_F(ElementFiles, OtherHeadersAreRefusedWithTheirLine) {
  const auto expect = [&](const std::string& old, const std::string& by, const std::string& said) {
    EXPECT_EQ(refusal(replaced(bytes, old, by)).substr(0, said.size()), said);
  };
  expect("ply\n", "plx\n", "a.ply:1: ");
  expect("little", "big", "a.ply:2: ");
  expect("comment Fluxel", "comment Blender", "a.ply:3: ");
  expect("double x", "float x", "a.ply:6: ");
  expect("face 2", "face two", "a.ply:9: is no number");
  expect("face 2", "face 2 ", "a.ply:9: is no number");
  expect("face 2", "face 0", "a.ply:9: is no number");
  expect("vertex 5", "vertex -5", "a.ply:5: is no number");
  expect("uchar uint", "uchar int", "a.ply:10: ");
  expect("error_g", "error_b", "a.ply:15: ");
  expect("property float error_r", "property double error_r", "a.ply:14: is neither");
  expect("float error_r\nproperty float error_g\nproperty float error_b",
         "float radiosity_r\nproperty float radiosity_g\nproperty float radiosity_b",
         "a.ply:14: names no new layer");
  expect("property uint patch\n", "", "a.ply:20: is neither");
  EXPECT_NE(refusal("ply\n").find("ends too early"), std::string::npos);
  EXPECT_NE(refusal("").find("ends too early"), std::string::npos);
}

TEST_F(ElementFiles, WithoutALayerAreRefused) {
  write_element_file(folder / "none.ply", elements, {});
  EXPECT_NE(refusal(bytes_of(folder / "none.ply")).find("no layer"), std::string::npos);
}

TEST_F(ElementFiles, CountsThatTheFileCannotHoldAreRefusedBeforeAnyRoomIsMade) {
  for (const char* count : {"3", "1000", "18446744073709551615"}) {
    EXPECT_NE(refusal(replaced(bytes, "face 2", std::string("face ") + count)), "") << count;
    EXPECT_NE(refusal(replaced(bytes, "vertex 5", std::string("vertex ") + count)), "") << count;
  }
  for (const char* of : {"vertex 5", "face 2"})
    EXPECT_NE(refusal(replaced(bytes, of, std::string(of) + "000000")).find("cannot hold"),
              std::string::npos);
}

TEST_F(ElementFiles, ThatAreCutOffOrTooLongAreRefused) {
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_NE(refusal(bytes.substr(0, length)), "") << length;
  EXPECT_NE(refusal(bytes + "x").find("more bytes"), std::string::npos);
}

TEST_F(ElementFiles, ValuesThatCannotBeAreRefusedWithTheirByte) {
  const std::size_t vertices = bytes.find("end_header\n") + 11, faces = vertices + std::size_t{5} * 24;
  const auto expect = [&](std::size_t at, auto value, const std::string& what) {
    std::string damaged = bytes;
    std::memcpy(damaged.data() + at, &value, sizeof value);
    EXPECT_NE(refusal(damaged).find(what), std::string::npos) << refusal(damaged);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect(vertices + 8, nan, "byte " + std::to_string(vertices + 8) + ": a coordinate that is not finite");
  expect(faces, std::uint8_t{5}, "a face of 5 corners");
  expect(faces + 1, std::uint32_t{5}, "vertex 5 of a face, where there are 5");
  expect(faces + 17 + 8, std::numeric_limits<float>::infinity(), "a value that is not finite");
}

TEST_F(ElementFiles, ThatAreNotThereOrFoldersAreRefused) {
  EXPECT_THROW(static_cast<void>(read_element_file(folder / "none.ply")), InputError);
  EXPECT_THROW(static_cast<void>(read_element_file(folder)), InputError);
}

TEST_F(ElementFiles, LayersOfOtherElementsAreADefect) {
  const std::vector<Rgb> one(1, Rgb(0));
  layers[1].values = one;
  EXPECT_THROW(write_element_file(folder / "b.ply", elements, layers), std::logic_error);
}

TEST_F(ElementFiles, ColouredElementsHoldColourValueAndPatch) {
  const std::vector<std::uint8_t> rgb{1, 2, 3, 4, 5, 6};
  write_coloured_elements(folder / "c.ply", elements, rgb, "error", std::vector<double>{0.5, -2},
                          "red: above");
  const std::string coloured = bytes_of(folder / "c.ply");
  EXPECT_NE(coloured.find("\ncomment red: above\n"), std::string::npos);
  EXPECT_NE(
      coloured.find("property list uchar uint vertex_indices\nproperty uchar red\nproperty uchar green\n"
                    "property uchar blue\nproperty float error\nproperty uint patch\nend_header\n"),
      std::string::npos);
  const std::string last = coloured.substr(coloured.size() - 11);
  EXPECT_EQ(last.substr(0, 3), "\4\5\6");
  float value = 0;
  std::memcpy(&value, last.data() + 3, sizeof value);
  EXPECT_EQ(value, -2);
  EXPECT_EQ(last[7], 9);
}

}  // namespace
}  // namespace fluxel
