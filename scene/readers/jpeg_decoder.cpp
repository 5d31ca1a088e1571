#include <array>
#include <csetjmp>
#include <cstdio>

// After <cstdio>, which they need.
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>

#include "core/input_error_at.hpp"
#include "scene/readers/decoded_image.hpp"

namespace fluxel {
namespace {

/// A block of 64 pixels takes a bit at least.
constexpr double kMostOfEntropyCode = 8 * 64;

/// A scan costs time for all pixels, and few bytes; encoders make about ten.
constexpr int kMaxScans = 100;

/// Of marks around the pixels; all other warnings are of pixels that are lost.
constexpr std::array kHarmless{static_cast<int>(JWRN_ADOBE_XFORM), static_cast<int>(JWRN_EXTRANEOUS_DATA),
                               static_cast<int>(JWRN_JFIF_MAJOR)};

/// All that outlives a jump out of libjpeg.
struct JpegReading {
  JpegReading(const std::filesystem::path& name, const std::string& data) : file(name), bytes(data) {}
  ~JpegReading() { jpeg_destroy_decompress(&info); }
  JpegReading(const JpegReading&) = delete;
  JpegReading& operator=(const JpegReading&) = delete;

  const std::filesystem::path& file;
  const std::string& bytes;
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf back{};
  DecodedImage image;
  std::string fault;
};

void end_jpeg(j_common_ptr info) {
  JpegReading& reading = *static_cast<JpegReading*>(info->client_data);
  std::array<char, JMSG_LENGTH_MAX> message{};
  info->err->format_message(info, message.data());
  reading.fault = message.data();
  std::longjmp(reading.back, 1);  // NOLINT: libjpeg's way of telling
}

void judge_warning(j_common_ptr info, int level) {
  if (level < 0 && std::ranges::find(kHarmless, info->err->msg_code) == kHarmless.end()) end_jpeg(info);
}

void count_scans(j_common_ptr info) {
  JpegReading& reading = *static_cast<JpegReading*>(info->client_data);
  if (reading.info.input_scan_number <= kMaxScans) return;
  reading.fault = "it has too many scans";
  std::longjmp(reading.back, 1);  // NOLINT
}

void read_jpeg_header(JpegReading& reading) {
  jpeg_decompress_struct& info = reading.info;
  jpeg_create_decompress(&info);
  info.client_data = &reading;
  info.progress = &reading.progress;
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(reading.bytes.data()), reading.bytes.size());
  jpeg_read_header(&info, TRUE);
  if (info.num_components != 1 && info.num_components != 3) {
    throw input_error_at(reading.file, 0, "a JPEG image of CMYK or other inks has no certain reflectance",
                         "save it as RGB");
  }
  require_usable_size(reading.file, info.image_width, info.image_height, reading.bytes.size(),
                      kMostOfEntropyCode);
  reading.image.width = static_cast<int>(info.image_width);
  reading.image.height = static_cast<int>(info.image_height);
}

void read_jpeg_pixels(JpegReading& reading) {
  jpeg_decompress_struct& info = reading.info;
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  const std::size_t row_bytes = std::size_t{3} * info.output_width;
  reading.image.samples.resize(row_bytes * info.output_height);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = reading.image.samples.data() + row_bytes * info.output_scanline;
    jpeg_read_scanlines(&info, &row, 1);
  }
}

/// False where libjpeg found a fault. What the jump leaves behind has no destructors.
bool read_jpeg(JpegReading& reading) {
  if (setjmp(reading.back) != 0) return false;  // NOLINT: libjpeg's way of telling
  read_jpeg_header(reading);
  read_jpeg_pixels(reading);
  return true;
}

}  // namespace

DecodedImage decode_jpeg(const std::filesystem::path& file, const std::string& bytes) {
  JpegReading reading(file, bytes);
  reading.info.err = jpeg_std_error(&reading.errors);
  reading.info.client_data = &reading;
  reading.errors.error_exit = end_jpeg;
  reading.errors.emit_message = judge_warning;
  reading.progress.progress_monitor = count_scans;
  if (!read_jpeg(reading)) refuse_damaged_image(file, reading.fault);
  return std::move(reading.image);
}

}  // namespace fluxel
