#include "scene/readers/texture.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/error.hpp"
#include "tests/unit/encoded_images.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::texture_test {
namespace {

using test_images::jpeg_of;
using test_images::png_of;
using test_images::Samples;
using test_messages::expect_words;

using Corners = std::vector<glm::dvec2>;

constexpr double kRounding = 1e-12;

Texture decode(const std::string& bytes) { return Texture::decode("dir/a.png", bytes); }

std::string error_of(const std::string& bytes) {
  try {
    static_cast<void>(decode(bytes));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A texture of grey pixels, rows from the top.
Texture grey(int width, int height, const Samples& values) {
  return decode(png_of(width, height, values, {.colour = PNG_COLOR_TYPE_GRAY}));
}

/// Black and white by turns; the upper left pixel is black.
Texture checker(int width, int height) {
  Samples values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) values.push_back((x + y) % 2 == 0 ? 0 : 255);
  return grey(width, height, values);
}

void expect_grey(const Rgb& colour, double value, double tolerance = kRounding) {
  for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(colour[c], value, tolerance);
}

TEST(Texture, DecodesSrgbExactly) {
  // IEC 61966-2-1: ((188 / 255 + 0.055) / 1.055)^2.4, and 10 / 255 / 12.92 on the straight part.
  expect_grey(grey(1, 1, {188}).mean(), 0.50288646, 1e-8);
  expect_grey(grey(1, 1, {10}).mean(), 10.0 / 255 / 12.92);
  expect_grey(grey(1, 1, {0}).mean(), 0);
  expect_grey(grey(1, 1, {255}).mean(), 1);
}

TEST(Texture, TakesTheMeanOfLinearValues) {
  expect_grey(checker(2, 2).mean(), 0.5);
  expect_grey(checker(40, 30).mean(), 0.5);
}

TEST(Texture, KeepsSixteenBits) {
  // One step of 16 bits above 8-bit code 128: 0x8081.
  const auto linear = [](double code) { return std::pow((code / 65535 + 0.055) / 1.055, 2.4); };
  const Samples values{0x80, 0x81, 0x40, 0x00, 0xFF, 0xFF};
  const Texture texture = decode(png_of(1, 1, values, {.bits = 16}));
  EXPECT_NEAR(texture.mean().r, linear(0x8081), kRounding);
  EXPECT_NEAR(texture.mean().g, linear(0x4000), kRounding);
  EXPECT_EQ(texture.mean().b, 1);
}

TEST(Texture, DecodesEveryPngForm) {
  // Each of these is red, blue over green, black.
  const std::vector<png_color> palette{{255, 0, 0}, {0, 0, 255}, {0, 255, 0}, {0, 0, 0}};
  const Samples rgb{255, 0, 0, 0, 0, 255, 0, 255, 0, 0, 0, 0};
  const Samples rgba{255, 0, 0, 255, 0, 0, 255, 255, 0, 255, 0, 255, 0, 0, 0, 255};
  const std::vector<std::string> files{
      png_of(2, 2, rgb), png_of(2, 2, rgb, {.interlaced = true}),
      png_of(2, 2, rgba, {.colour = PNG_COLOR_TYPE_RGBA}),
      png_of(2, 2, {0x10, 0xB0}, {.bits = 2, .colour = PNG_COLOR_TYPE_PALETTE, .palette = palette}),
      png_of(2, 2, {0, 1, 2, 3}, {.colour = PNG_COLOR_TYPE_PALETTE, .palette = palette})};
  for (std::size_t k = 0; k < files.size(); ++k) {
    SCOPED_TRACE(k);
    const Texture texture = decode(files[k]);
    EXPECT_EQ(texture.width(), 2);
    EXPECT_EQ(texture.height(), 2);
    EXPECT_FALSE(texture.has_alpha());
    const auto at = [&](double u, double v) { return texture.mean_over(Corners{{u, v}}); };
    EXPECT_EQ(at(0.25, 0.75), Rgb(1, 0, 0));
    EXPECT_EQ(at(0.75, 0.75), Rgb(0, 0, 1));
    EXPECT_EQ(at(0.25, 0.25), Rgb(0, 1, 0));
  }
}

TEST(Texture, DecodesInterlacedImagesAsOthers) {
  Samples values;
  for (int k = 0; k < 37 * 19 * 4; ++k) values.push_back(static_cast<std::uint8_t>(k * k % 251));
  const Texture plain = decode(png_of(37, 19, values, {.colour = PNG_COLOR_TYPE_RGBA}));
  const Texture interlaced =
      decode(png_of(37, 19, values, {.colour = PNG_COLOR_TYPE_RGBA, .interlaced = true}));
  for (int y = 0; y < 19; ++y) {
    for (int x = 0; x < 37; ++x) {
      const Corners at{{(x + 0.5) / 37, (y + 0.5) / 19}};
      ASSERT_EQ(plain.mean_over(at), interlaced.mean_over(at));
    }
  }
}

TEST(Texture, IgnoresGamma) {
  expect_grey(decode(png_of(1, 1, {188}, {.colour = PNG_COLOR_TYPE_GRAY, .gamma = 1.0})).mean(), 0.50288646,
              1e-8);
}

TEST(Texture, KnowsTransparentPixels) {
  EXPECT_TRUE(decode(png_of(2, 1, {9, 255, 9, 254}, {.colour = PNG_COLOR_TYPE_GRAY_ALPHA})).has_alpha());
  EXPECT_FALSE(decode(png_of(2, 1, {9, 255, 9, 255}, {.colour = PNG_COLOR_TYPE_GRAY_ALPHA})).has_alpha());
  const Samples deep{0, 9, 255, 255, 0, 9, 255, 254};
  EXPECT_TRUE(decode(png_of(2, 1, deep, {.bits = 16, .colour = PNG_COLOR_TYPE_GRAY_ALPHA})).has_alpha());
  const std::vector<png_color> palette{{255, 255, 255}, {0, 0, 0}};
  const test_images::PngForm form{
      .colour = PNG_COLOR_TYPE_PALETTE, .palette = palette, .palette_alpha = {255, 0}};
  const Texture texture = decode(png_of(2, 1, {0, 1}, form));
  EXPECT_TRUE(texture.has_alpha());
  expect_grey(texture.mean(), 0.5);  // transparent black counts as black
}

TEST(Texture, DecodesJpeg) {
  Samples colours;
  for (int k = 0; k < 16 * 16; ++k) colours.insert(colours.end(), {200, 100, 50});
  for (const bool progressive : {false, true}) {
    const Texture texture = decode(jpeg_of(16, 16, colours, JCS_RGB, progressive));
    EXPECT_EQ(texture.width(), 16);
    EXPECT_FALSE(texture.has_alpha());
    // YCbCr in 8 bits is off by one code or two, of which each is 0.003 to 0.006 here.
    EXPECT_NEAR(texture.mean().r, 0.5776, 0.012);
    EXPECT_NEAR(texture.mean().g, 0.1274, 0.006);
    EXPECT_NEAR(texture.mean().b, 0.0319, 0.004);
  }
  expect_grey(decode(jpeg_of(9, 5, Samples(45, 188), JCS_GRAYSCALE)).mean(), 0.50288646, 1e-8);
}

TEST(Texture, RefusesCmyk) {
  expect_words(error_of(jpeg_of(8, 8, Samples(8 * 8 * 4, 10), JCS_CMYK)), {"dir/a.png:", "CMYK", "as RGB"});
}

TEST(Texture, RefusesOtherFormats) {
  for (const std::string bytes : {"", "\x89PN", "BM not of these", "GIF89a"}) {
    EXPECT_FALSE(Texture::is_known(bytes));
    expect_words(error_of(bytes), {"dir/a.png:", "neither PNG nor JPEG", "convert"});
  }
}

Samples noise(int count) {
  Samples values;
  unsigned state = 1;
  for (int k = 0; k < count; ++k) {
    state = state * 1664525u + 1013904223u;
    values.push_back(static_cast<std::uint8_t>(state >> 24));
  }
  return values;
}

TEST(Texture, RefusesTruncatedFiles) {
  const Samples values = noise(32 * 32 * 3);
  for (const std::string& whole : {png_of(32, 32, values), png_of(32, 32, values, {.interlaced = true}),
                                   jpeg_of(32, 32, values), jpeg_of(32, 32, values, JCS_RGB, true)}) {
    ASSERT_EQ(error_of(whole), "no error");
    for (const double part : {0.2, 0.5, 0.9}) {
      const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
      expect_words(error_of(whole.substr(0, size)), {"dir/a.png:", "damaged", "save it again"});
    }
    expect_words(error_of(whole.substr(0, 12)), {"dir/a.png:", "damaged"});
  }
}

TEST(Texture, RefusesDamagedPixels) {
  std::string png = png_of(32, 32, noise(32 * 32 * 3)), jpeg = jpeg_of(64, 64, noise(64 * 64 * 3));
  png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 0x10);
  expect_words(error_of(png), {"damaged"});
  jpeg.replace(jpeg.size() / 2, 2, "\xFF\xD9");  // the end of an image
  expect_words(error_of(jpeg), {"damaged"});
}

/// The header of a PNG file, which may lie, and the rest of another.
std::string png_with_size(std::uint32_t width, std::uint32_t height) {
  std::string bytes = png_of(8, 8, Samples(8 * 8 * 3, 7));
  for (int k = 0; k < 4; ++k) {
    bytes[static_cast<std::size_t>(16 + k)] = static_cast<char>(width >> (24 - 8 * k));
    bytes[static_cast<std::size_t>(20 + k)] = static_cast<char>(height >> (24 - 8 * k));
  }
  // CRC of the chunk's name and data (ISO/IEC 15948, annex D).
  std::uint32_t crc = 0xFFFFFFFF;
  for (std::size_t k = 12; k < 29; ++k) {
    crc ^= static_cast<unsigned char>(bytes[k]);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320u : 0u);
  }
  crc = ~crc;
  for (int k = 0; k < 4; ++k)
    bytes[static_cast<std::size_t>(29 + k)] = static_cast<char>(crc >> (24 - 8 * k));
  return bytes;
}

std::string jpeg_with_size(unsigned width, unsigned height) {
  std::string bytes = jpeg_of(8, 8, Samples(8 * 8 * 3, 7));
  const std::size_t frame = bytes.find("\xFF\xC0");
  for (std::size_t k = 0; k < 2; ++k) {
    bytes[frame + 5 + k] = static_cast<char>(height >> (8 - 8 * k));
    bytes[frame + 7 + k] = static_cast<char>(width >> (8 - 8 * k));
  }
  return bytes;
}

TEST(Texture, RefusesHugeImagesFromTheirHeader) {
  EXPECT_EQ(error_of(png_with_size(8, 8)), "no error");  // the test's own CRC is right
  expect_words(error_of(png_with_size(100000, 100000)),
               {"dir/a.png:", "100000 x 100000", "too large", "16384"});
  expect_words(error_of(png_with_size(0x7FFFFFFF, 1)), {"2147483647 x 1", "too large"});
  expect_words(error_of(png_with_size(16384, 16384)), {"16384 x 16384", "too large", "67108864"});
  expect_words(error_of(jpeg_with_size(65000, 65000)), {"65000 x 65000", "too large"});
}

TEST(Texture, RefusesImagesThatLieAboutTheirSize) {
  expect_words(error_of(png_with_size(8192, 8192)), {"damaged", "bytes are too few", "8192 x 8192"});
  expect_words(error_of(jpeg_with_size(8192, 8192)), {"damaged", "bytes are too few", "8192 x 8192"});
  expect_words(error_of(png_with_size(8, 9)), {"damaged"});
  expect_words(error_of(jpeg_with_size(64, 8)), {"damaged"});
}

// Means over polygons. Coordinates go up from the lower left, where images begin at the top.

TEST(Texture, MeanOverWholeAndPartialPixels) {
  const Texture texture = grey(2, 2, {255, 0, 0, 0});  // white at the upper left
  expect_grey(texture.mean_over(Corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}}), 0.25);
  expect_grey(texture.mean_over(Corners{{0, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}}), 1);
  expect_grey(texture.mean_over(Corners{{0, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}), 0);
  // A quarter of the white pixel's width and all of its height, in 3/4 of the width: 1/3 of the upper half.
  expect_grey(texture.mean_over(Corners{{0.25, 0.5}, {1, 0.5}, {1, 1}, {0.25, 1}}), 1.0 / 3);
  // All of the white pixel, 1/4 of the image, lies above v = u, in a triangle of 1/2.
  expect_grey(texture.mean_over(Corners{{0, 0}, {1, 1}, {0, 1}}), 0.5);
  // v + u = 1 halves the white pixel: 1/8 of 1/2 below, and as much above.
  expect_grey(texture.mean_over(Corners{{0, 0}, {1, 0}, {0, 1}}), 0.25);
  expect_grey(texture.mean_over(Corners{{1, 0}, {1, 1}, {0, 1}}), 0.25);
}

TEST(Texture, MeanDoesNotDependOnOrientationOrStart) {
  const Texture texture = grey(3, 2, {255, 0, 188, 20, 90, 140});
  const Corners corners{{0.1, 0.2}, {1.7, 0.3}, {1.2, 1.9}, {-0.4, 0.8}};
  const Rgb expected = texture.mean_over(corners);
  EXPECT_GT(expected.r, 0);
  expect_grey(texture.mean_over(Corners(corners.rbegin(), corners.rend())), expected.r);
  expect_grey(texture.mean_over(Corners{corners[2], corners[3], corners[0], corners[1]}), expected.r);
}

TEST(Texture, RepeatsInBothDirections) {
  const Texture texture = grey(3, 2, {255, 0, 188, 20, 90, 140});
  const Corners corners{{0.1, 0.2}, {0.7, 0.3}, {0.5, 0.9}};
  const Rgb expected = texture.mean_over(corners);
  for (const glm::dvec2 shift : {glm::dvec2(5, 0), {0, -3}, {-7, 11}, {1000, -1000}}) {
    Corners moved = corners;
    for (glm::dvec2& corner : moved) corner += shift;
    expect_grey(texture.mean_over(moved), expected.r, 1e-10);  // 13 digits of the coordinates are left
  }
  // Coordinates of few binary digits, which are exact far away as well.
  const Corners near{{0.125, 0.25}, {0.75, 0.375}, {0.5, 0.875}};
  Corners far = near;
  for (glm::dvec2& corner : far) corner += glm::dvec2(1 << 30, -(1 << 30));
  EXPECT_EQ(texture.mean_over(far), texture.mean_over(near));
  expect_grey(texture.mean_over(Corners{{-1, -1}, {2, -1}, {2, 3}, {-1, 3}}), texture.mean().r);
  // Two repeats and the left pixel of a third: (2 * mean * 3 + left) / 7, by pixels of a row.
  const double left = (grey(1, 2, {255, 20}).mean()).r;
  expect_grey(texture.mean_over(Corners{{0, 0}, {7.0 / 3, 0}, {7.0 / 3, 1}, {0, 1}}),
              (6 * texture.mean().r + left) / 7);
}

TEST(Texture, AgreesWithSamples) {
  const Texture texture = grey(40, 23, noise(40 * 23));
  const Corners triangle{{-0.63, 0.21}, {1.31, -0.48}, {0.42, 1.77}};
  Rgb sum{0};
  constexpr int kPoints = 1000;
  int count = 0;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; i + j < kPoints; ++j) {
      const double a = (i + 1.0 / 3) / kPoints, b = (j + 1.0 / 3) / kPoints;
      sum += texture.mean_over(Corners{(1 - a - b) * triangle[0] + a * triangle[1] + b * triangle[2]});
      ++count;
    }
  }
  // Half a million points, of values that vary by 0.3: off by 4e-4 if they were random.
  expect_grey(texture.mean_over(triangle), sum.r / count, 4e-4);
}

TEST(Texture, ConcavePolygonsCountTheirOwnArea) {
  const Texture texture = grey(2, 2, {255, 0, 0, 0});
  // An L without the upper right quarter: white is 1 of its 3 pixels.
  expect_grey(texture.mean_over(Corners{{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}}), 1.0 / 3);
}

TEST(Texture, WithoutAreaThePixelOfTheFirstCorner) {
  const Texture texture = grey(2, 2, {255, 0, 188, 10});
  expect_grey(texture.mean_over(Corners{{0.2, 0.7}}), 1);
  expect_grey(texture.mean_over(Corners{{0, 0}, {0, 0}, {0, 0}}), 0.50288646, 1e-8);
  expect_grey(texture.mean_over(Corners{{0.7, 0.2}, {0.9, 0.9}, {0.8, 0.55}}), 10.0 / 255 / 12.92);
  expect_grey(texture.mean_over(Corners{{-0.7, -1.2}, {5, 3}}), 1);
  EXPECT_EQ(texture.mean_over(Corners{}), texture.mean());
}

TEST(Texture, SmallPolygonsLieInTheirPixel) {
  const Texture texture = grey(400, 400, noise(400 * 400));
  for (const double size : {1e-4, 1e-6, 1e-8, 1e-10, 1e-13}) {
    const glm::dvec2 at{0.73037, 0.41163};  // pixel 292.148 x 164.652
    const Rgb expected = texture.mean_over(Corners{at});
    expect_grey(texture.mean_over(Corners{at, at + glm::dvec2(size, 0), at + glm::dvec2(0, size)}),
                expected.r, 1e-5);
  }
}

TEST(Texture, ManyRepeatsTakeNoTime) {
  const Texture texture = checker(1024, 1024);
  const auto start = std::chrono::steady_clock::now();
  for (const double repeats : {1e2 + 0.1, 1e4 + 0.1, 1e9, 1e15, 1e300}) {
    const Corners square{{0, 0}, {repeats, 0.3}, {repeats, repeats}, {0, repeats}};
    expect_grey(texture.mean_over(square), 0.5, 1e-3);
  }
  const double infinite = std::numeric_limits<double>::infinity();
  expect_grey(texture.mean_over(Corners{{0, 0}, {infinite, 0}, {1, 1}}), 0.5);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));  // of 1e9 repeats: hours
}

TEST(Texture, StaysWithinReflectances) {
  const Texture texture = grey(31, 17, Samples(31 * 17, 255));
  for (int k = 0; k < 1000; ++k) {
    const double a = std::sin(k), b = std::sin(1.7 * k + 1), c = std::sin(2.9 * k + 2);
    const Rgb mean = texture.mean_over(Corners{{a, b}, {c + 1, a * c}, {b * c, a + 2}});
    EXPECT_LE(mean.r, 1);
    EXPECT_GE(mean.r, 1 - 1e-6);
  }
}

}  // namespace
}  // namespace fluxel::texture_test
