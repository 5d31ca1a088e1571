#include <png.h>

#include <csetjmp>
#include <cstring>

#include "scene/readers/decoded_image.hpp"

namespace fluxel {
namespace {

/// Bytes of a row that zlib (RFC 1951) makes of one byte at most.
constexpr double kMostOfDeflate = 1032;

/// All that outlives a jump out of libpng.
struct PngReading {
  PngReading(const std::filesystem::path& name, const std::string& data) : file(name), bytes(data) {}
  ~PngReading() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReading(const PngReading&) = delete;
  PngReading& operator=(const PngReading&) = delete;

  const std::filesystem::path& file;
  const std::string& bytes;
  std::size_t next = 0;
  png_structp png = nullptr;
  png_infop info = nullptr;
  DecodedImage image;
  std::string fault;
};

void end_png(png_structp png, png_const_charp message) {
  static_cast<PngReading*>(png_get_error_ptr(png))->fault = message;
  png_longjmp(png, 1);
}

/// Of chunks that are not pixels.
void pass_over_warning(png_structp, png_const_charp) {}

void give_png_bytes(png_structp png, png_bytep out, std::size_t count) {
  PngReading& reading = *static_cast<PngReading*>(png_get_io_ptr(png));
  if (count > reading.bytes.size() - reading.next) png_error(png, "it ends too early");
  std::memcpy(out, reading.bytes.data() + reading.next, count);
  reading.next += count;
}

void read_png_header(PngReading& reading) {
  const png_structp png = reading.png;
  png_set_read_fn(png, &reading, give_png_bytes);
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // require_usable_size tells of them
  png_set_chunk_cache_max(png, 1);                             // no texts
  png_read_info(png, reading.info);

  const png_uint_32 width = png_get_image_width(png, reading.info);
  const png_uint_32 height = png_get_image_height(png, reading.info);
  const int bits = png_get_bit_depth(png, reading.info) * png_get_channels(png, reading.info);
  require_usable_size(reading.file, width, height, reading.bytes.size(), kMostOfDeflate * 8 / bits);
  reading.image.width = static_cast<int>(width);
  reading.image.height = static_cast<int>(height);
}

void read_png_pixels(PngReading& reading) {
  const png_structp png = reading.png;
  png_set_expand(png);  // palettes, grey of few bits, and transparent colours
  png_set_gray_to_rgb(png);
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, reading.info);

  DecodedImage& image = reading.image;
  image.channels = png_get_channels(png, reading.info);
  image.deep = png_get_bit_depth(png, reading.info) == 16;
  const std::size_t row_bytes = png_get_rowbytes(png, reading.info);
  image.samples.resize(row_bytes * static_cast<std::size_t>(image.height));
  for (int pass = 0; pass < passes; ++pass) {
    png_bytep row = image.samples.data();
    for (int y = 0; y < image.height; ++y, row += row_bytes) png_read_row(png, row, nullptr);
  }
}

/// False where libpng found a fault. What the jump leaves behind has no destructors.
bool read_png(PngReading& reading) {
  if (setjmp(png_jmpbuf(reading.png)) != 0) return false;  // NOLINT: libpng's way of telling
  read_png_header(reading);
  read_png_pixels(reading);
  return true;
}

}  // namespace

DecodedImage decode_png(const std::filesystem::path& file, const std::string& bytes) {
  PngReading reading(file, bytes);
  reading.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, end_png, pass_over_warning);
  if (reading.png != nullptr) reading.info = png_create_info_struct(reading.png);
  if (reading.info == nullptr) throw std::bad_alloc();
  if (!read_png(reading)) refuse_damaged_image(file, reading.fault);
  return std::move(reading.image);
}

}  // namespace fluxel
