#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "image/exr_writer.hpp"
#include "image/png_writer.hpp"
#include "tests/unit/file_bytes.hpp"
#include "tests/unit/full_disk.hpp"

namespace fluxel {
namespace {

namespace fs = std::filesystem;

class ImageFile : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) /
             ("fluxel_image_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  fs::path folder;
};

/// Every value of every layer differs from the others.
Picture numbered_picture(int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    const auto n = static_cast<double>(i);
    picture.radiance.emplace_back(n + 0.1, n + 0.2, n + 0.3);
    picture.element.push_back(
        ElementId{static_cast<std::uint32_t>(16777216 + i)});  // no float holds 16777217
    picture.depth.push_back(static_cast<float>(1000 + n));
    picture.normal.emplace_back(n + 2000.1, n + 2000.2, n + 2000.3);
    picture.reflectance.emplace_back(n + 3000.1, n + 3000.2, n + 3000.3);
    picture.irradiance.emplace_back(n + 4000.1, n + 4000.2, n + 4000.3);
  }
  picture.element.back() = kNoElement;
  picture.depth.back() = std::numeric_limits<float>::infinity();
  return picture;
}

template <class T>
std::vector<T> read_channel(Imf::InputFile& file, const std::string& name, Imf::PixelType type) {
  const Imf::Channel* channel = file.header().channels().findChannel(name);
  if (channel == nullptr || channel->type != type) {
    ADD_FAILURE() << "no such channel, or of another type: " << name;
    return {};
  }
  const auto& window = file.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x + 1);
  std::vector<T> values(width * static_cast<std::size_t>(window.max.y + 1));
  Imf::FrameBuffer buffer;
  buffer.insert(name, Imf::Slice(type, reinterpret_cast<char*>(values.data()), sizeof(T), width * sizeof(T)));
  file.setFrameBuffer(buffer);
  file.readPixels(0, window.max.y);
  return values;
}

template <class Vec>
void expect_layer(Imf::InputFile& file, const std::string& layer, const std::string& components,
                  const std::vector<Vec>& expected) {
  for (int c = 0; c < 3; ++c) {
    const auto name = layer + components[static_cast<std::size_t>(c)];
    const auto values = read_channel<float>(file, name, Imf::FLOAT);
    ASSERT_EQ(values.size(), expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_EQ(values[i], static_cast<float>(expected[i][c])) << name << " at " << i;
    }
  }
}

TEST_F(ImageFile, ExrHoldsEveryLayerAndTheAttributes) {
  const Picture picture = numbered_picture(19, 37);  // more rows than a ZIP block of 16
  const fs::path path = folder / "image.exr";
  const std::string long_name(60, 'n');
  write_exr(path, picture, {{"fluxel.version", "1.2.3"}, {"fluxel.time", "4.5 s"}, {long_name, ""}});

  Imf::InputFile file(path.c_str());
  EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("fluxel.version").value(), "1.2.3");
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("fluxel.time").value(), "4.5 s");
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>(long_name).value(), "");
  std::set<std::string> names;
  for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
    names.insert(it.name());
  }
  const std::set<std::string> expected_names = {"R",
                                                "G",
                                                "B",
                                                "element.id",
                                                "depth.Z",
                                                "normal.X",
                                                "normal.Y",
                                                "normal.Z",
                                                "reflectance.R",
                                                "reflectance.G",
                                                "reflectance.B",
                                                "irradiance.R",
                                                "irradiance.G",
                                                "irradiance.B"};
  EXPECT_EQ(names, expected_names);

  expect_layer(file, "", "RGB", picture.radiance);
  expect_layer(file, "normal.", "XYZ", picture.normal);
  expect_layer(file, "reflectance.", "RGB", picture.reflectance);
  expect_layer(file, "irradiance.", "RGB", picture.irradiance);
  EXPECT_EQ(read_channel<float>(file, "depth.Z", Imf::FLOAT), picture.depth);
  const auto ids = read_channel<std::uint32_t>(file, "element.id", Imf::UINT);
  ASSERT_EQ(ids.size(), picture.pixels());
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(ids[i], index(picture.element[i]));
}

TEST_F(ImageFile, ExrHasTheSameBytesForTheSamePicture) {
  const Picture picture = numbered_picture(33, 20);
  write_exr(folder / "a.exr", picture, {{"fluxel.options", "none"}});
  write_exr(folder / "b.exr", picture, {{"fluxel.options", "none"}});
  EXPECT_FALSE(bytes_of(folder / "a.exr").empty());
  EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
}

TEST_F(ImageFile, ExrAttributesThatCannotStandInTheHeaderAreADefect) {
  const Picture picture = numbered_picture(2, 2);
  EXPECT_ANY_THROW(write_exr(folder / "a.exr", picture, {{"compression", "none"}}));
  EXPECT_ANY_THROW(write_exr(folder / "a.exr", picture, {{"", "none"}}));
  EXPECT_TRUE(fs::is_empty(folder));
}

DisplayPicture numbered_display(int width, int height) {
  DisplayPicture display;
  display.width = width;
  display.height = height;
  for (int i = 0; i < 3 * width * height; ++i) display.rgb.push_back(static_cast<std::uint8_t>(i * 7));
  return display;
}

TEST_F(ImageFile, PngHoldsThePixelsAsSrgb) {
  const DisplayPicture display = numbered_display(13, 9);
  const fs::path path = folder / "image.png";
  write_png(path, display);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << image.message;
  EXPECT_EQ(image.width, 13u);
  EXPECT_EQ(image.height, 9u);
  EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
  std::vector<std::uint8_t> values(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, values.data(), 0, nullptr), 0) << image.message;
  EXPECT_EQ(values, display.rgb);

  // Signature, IHDR of 8 bits RGB, then the sRGB chunk of one byte.
  const std::string bytes = bytes_of(path);
  EXPECT_EQ(bytes.substr(12, 4), "IHDR");
  EXPECT_EQ(bytes[24], 8);
  EXPECT_EQ(bytes[25], 2);
  EXPECT_NE(bytes.find(std::string("\0\0\0\1sRGB", 8)), std::string::npos);
}

TEST_F(ImageFile, AFullDiskIsAnInputErrorAndLeavesNothing) {
  const auto expect_full = [&](const char* name, const auto& write) {
    try {
      const FullDisk full;
      write(folder / name);
      ADD_FAILURE() << "written to a full disk";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("File too large"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(fs::is_empty(folder));
  };
  // A few bytes fail when the file is closed, many when they are written.
  for (const int width : {1, 300}) {
    expect_full("image.exr",
                [&](const fs::path& file) { write_exr(file, numbered_picture(width, 300), {}); });
    expect_full("image.png", [&](const fs::path& file) { write_png(file, numbered_display(width, width)); });
  }
}

TEST_F(ImageFile, AMissingFolderIsAnInputError) {
  EXPECT_THROW(write_exr(folder / "none" / "image.exr", numbered_picture(2, 2), {}), InputError);
  EXPECT_THROW(write_png(folder / "none" / "image.png", numbered_display(2, 2)), InputError);
}

}  // namespace
}  // namespace fluxel
