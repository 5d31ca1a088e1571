#include "image/exr_reader.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/error.hpp"
#include "image/exr_writer.hpp"
#include "tests/unit/file_bytes.hpp"

namespace fluxel {
namespace {

namespace fs = std::filesystem;

class ExrReader : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) /
             ("fluxel_exr_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    file = folder / "a.exr";
  }
  void TearDown() override { fs::remove_all(folder); }

  /// What the file is refused with; empty where it is taken.
  [[nodiscard]] std::string refusal() const {
    try {
      static_cast<void>(read_exr(file));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  void expect_refused(const std::string& what) const {
    EXPECT_NE(refusal().find(what), std::string::npos) << refusal();
    EXPECT_TRUE(refusal().starts_with(file.string() + ": "));
  }

  fs::path folder, file;
};

LayeredImage numbered_image(int width, int height) {
  LayeredImage image;
  image.width = width;
  image.height = height;
  for (const char* name : {"", "error", "of.two.words"}) {
    auto& values = image.layers[name];
    const auto first = 1000.0 * static_cast<double>(image.layers.size());
    for (std::size_t i = 0; i < image.pixels(); ++i)
      values.emplace_back(first + static_cast<double>(i), -first, 0.25 * static_cast<double>(i));
  }
  return image;
}

TEST_F(ExrReader, ReadsWhatIsWritten) {
  const LayeredImage image = numbered_image(19, 37);
  write_exr(file, image, {{"fluxel.version", "1"}});
  const LayeredImage read = read_exr(file);
  EXPECT_EQ(read.width, 19);
  EXPECT_EQ(read.height, 37);
  EXPECT_EQ(read.layers, image.layers);
}

TEST_F(ExrReader, WritesTheSameBytesAgain) {
  write_exr(file, numbered_image(5, 3), {});
  write_exr(folder / "b.exr", read_exr(file), {});
  EXPECT_FALSE(bytes_of(file).empty());
  EXPECT_EQ(bytes_of(file), bytes_of(folder / "b.exr"));
}

TEST_F(ExrReader, LeavesOtherLayersOfAPictureOut) {
  Picture picture;
  picture.width = 2;
  picture.height = 1;
  picture.radiance = {Rgb(1, 2, 3), Rgb(4, 5, 6)};
  picture.element.assign(2, kNoElement);
  picture.depth.assign(2, std::numeric_limits<float>::infinity());
  picture.normal.assign(2, glm::vec3(0));
  picture.reflectance.assign(2, Rgb(0.5));
  picture.irradiance.assign(2, Rgb(7));
  write_exr(file, picture, {});
  const LayeredImage read = read_exr(file);
  EXPECT_EQ(read.layers.at(""), picture.radiance);
  EXPECT_EQ(read.layers.at("irradiance"), picture.irradiance);
  EXPECT_EQ(read.layers.size(), 3u);
}

TEST_F(ExrReader, ALayerWithoutAValueForEachPixelIsADefect) {
  LayeredImage image = numbered_image(2, 2);
  image.layers["error"].pop_back();
  EXPECT_THROW(write_exr(file, image, {}), std::logic_error);
}

/// Half floats in an offset window, rows from the bottom up, 3 x 2 pixels: R counts from 0.
TEST_F(ExrReader, ReadsHalfFloatsAtAnOffsetFromTheBottomUp) {
  const Imath::Box2i window({-5, 7}, {-3, 8});
  Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
  header.lineOrder() = Imf::DECREASING_Y;
  half values[2][3][3];
  Imf::FrameBuffer buffer;
  for (int c = 0; c < 3; ++c) {
    const std::string name = std::string(1, "RGB"[c]);
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x) values[y][x][c] = half(static_cast<float>(3 * y + x + 100 * c));
    buffer.insert(name,
                  Imf::Slice::Make(Imf::HALF, &values[0][0][c], window, 3 * sizeof(half), 9 * sizeof(half)));
  }
  {
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(2);
  }
  const LayeredImage read = read_exr(file);
  EXPECT_EQ(read.width, 3);
  EXPECT_EQ(read.height, 2);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto n = static_cast<double>(i);
    EXPECT_EQ(read.layers.at("").at(i), Rgb(n, 100 + n, 200 + n));
  }
}

/// One pixel with these channels, of one type.
void write_channels(const fs::path& file, const std::vector<std::string>& names, Imf::PixelType type) {
  Imf::Header header(1, 1);
  Imf::FrameBuffer buffer;
  std::uint32_t value = 0;
  for (const std::string& name : names) {
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, Imf::Slice(type, reinterpret_cast<char*>(&value), 4, 4));
  }
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(buffer);
  output.writePixels(1);
}

TEST_F(ExrReader, RefusesLayersThatAreNotOfThreeColours) {
  write_channels(file, {"Y"}, Imf::FLOAT);
  expect_refused("channel R is missing");
  write_channels(file, {"R", "G"}, Imf::FLOAT);
  expect_refused("channel B is missing");
  write_channels(file, {"R", "G", "B", "error.G"}, Imf::FLOAT);
  expect_refused("channel error.R is missing");
  write_channels(file, {"R", "G", "B"}, Imf::UINT);
  expect_refused("whole numbers");
}

TEST_F(ExrReader, RefusesValuesThatAreNotFinite) {
  LayeredImage image = numbered_image(3, 2);
  image.layers["error"][4].b = std::nan("");
  write_exr(file, image, {});
  expect_refused("pixel 1,1 of channels error.R, G, B is not finite");
}

TEST_F(ExrReader, RefusesTiles) {
  Imf::Header header(8, 8);
  for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  header.setTileDescription(Imf::TileDescription(4, 4));
  { const Imf::TiledOutputFile output(file.c_str(), header); }
  expect_refused("tiles");
}

TEST_F(ExrReader, RefusesWhatIsNotThereOrNoPicture) {
  expect_refused("no such file");
  std::ofstream(file) << "";
  expect_refused("no OpenEXR file");
  std::ofstream(file) << "ply\nformat binary\n";
  expect_refused("no OpenEXR file");
  file = folder;
  EXPECT_NE(refusal(), "");
}

TEST_F(ExrReader, RefusesAFileThatIsCutOff) {
  write_exr(file, numbered_image(19, 37), {});
  const auto size = fs::file_size(file);
  for (std::uintmax_t length = 0; length < size; length += 61) {
    write_exr(file, numbered_image(19, 37), {});
    fs::resize_file(file, length);
    EXPECT_NE(refusal(), "") << length;
  }
}

TEST_F(ExrReader, RefusesASizeThatTheFileCannotHold) {
  write_exr(file, numbered_image(3, 2), {});
  const std::string bytes = bytes_of(file);
  const auto with_size = [&](std::int32_t last_column, std::int32_t last_row) {
    std::string large = bytes;
    const std::size_t value = large.find(std::string("dataWindow\0box2i\0\20\0\0\0", 21)) + 21;
    large.replace(value + 8, 4, reinterpret_cast<const char*>(&last_column), 4);
    large.replace(value + 12, 4, reinterpret_cast<const char*>(&last_row), 4);
    std::ofstream(file, std::ios::binary) << large;
  };
  with_size(65535, 65535);
  expect_refused("cannot hold");
  with_size(65536, 1);
  expect_refused("65537 x 2 pixels");
  with_size(1, std::numeric_limits<std::int32_t>::max());
  expect_refused("1 to 65536 a side");
}

TEST_F(ExrReader, RefusesAnAttributeLongerThanTheFile) {
  write_exr(file, numbered_image(3, 2), {{"fluxel.version", "0123456789"}});
  const auto with_length = [&](std::int32_t length) {
    std::string bytes = bytes_of(file);
    const std::size_t value = bytes.find(std::string("fluxel.version\0string\0", 22)) + 22;
    bytes.replace(value, 4, reinterpret_cast<const char*>(&length), 4);
    std::ofstream(file, std::ios::binary) << bytes;
  };
  for (const std::int32_t length : {1'714'487'297, std::numeric_limits<std::int32_t>::max(), -1}) {
    with_length(length);
    expect_refused("the attribute 'fluxel.version' is said to have " + std::to_string(length) + " bytes");
  }
  file = fs::path(FLUXEL_SOURCE_DIR) / "tests/fuzz/corpus/exr/long_attribute.exr";
  expect_refused("the attribute 'fluxel.threads' is said to have 1714487297 bytes");
}

/// OpenEXR reads these by their types: what is left of a longer value would be the next attribute to it.
TEST_F(ExrReader, BelievesNoLengthThatTheTypeDoesNotHave) {
  write_exr(file, numbered_image(3, 2), {});
  std::string bytes = bytes_of(file);
  const std::string before("pixelAspectRatio\0float\0", 23);
  const std::size_t length = bytes.find(before) + before.size();
  ASSERT_EQ(bytes[length], 4);
  bytes[length] = 9;
  bytes.insert(length + 8, 5, 'x');
  std::ofstream(file, std::ios::binary) << bytes;
  expect_refused("the attribute 'pixelAspectRatio' is damaged");
  file = fs::path(FLUXEL_SOURCE_DIR) / "tests/fuzz/corpus/exr/channels_that_end_early.exr";
  expect_refused("the attribute 'channels' is damaged");
}

/// A preview of 65535 x 65535 pixels, and a string of 2^31 - 1 bytes in a vector: neither is looked at.
TEST_F(ExrReader, BelievesNoLengthWithinAnAttribute) {
  const LayeredImage image = numbered_image(3, 2);
  // Eight bytes, as a preview of no pixels has, in the place of the text and its type.
  write_exr(file, image, {{"fluxel.a", "12345678"}, {"fluxel.bcde", "1234"}});
  std::string bytes = bytes_of(file);
  const auto replace = [&](const std::string& what, const std::string& with) {
    ASSERT_NE(bytes.find(what), std::string::npos);
    bytes.replace(bytes.find(what), what.size(), with);
  };
  using namespace std::string_literals;
  replace("fluxel.a\0string\0\10\0\0\0"s + "12345678",
          "preview\0preview\0\10\0\0\0\377\377\0\0\377\377\0\0"s);
  replace("fluxel.bcde\0string\0\4\0\0\0"s + "1234", "view.\0stringvector\0\4\0\0\0\377\377\377\177"s);
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(read_exr(file).layers, image.layers);
}

/// A block of DWAB has 256 rows, though the picture has one: 503 channels of it would be 33 GB.
TEST_F(ExrReader, RefusesRowsThatTheFileCannotHold) {
  Imf::Header header(65536, 1);
  header.compression() = Imf::DWAB_COMPRESSION;
  for (const char* name : {"R", "G", "B", "a", "b", "c"})
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  { const Imf::OutputFile output(file.c_str(), header); }
  expect_refused("cannot hold 6 channels of 65536 x 1 pixels");
}

}  // namespace
}  // namespace fluxel
