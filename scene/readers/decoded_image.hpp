#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fluxel {

/// The pixels of an image file as it codes them.
struct DecodedImage {
  int width = 0, height = 0;
  int channels = 3;                   ///< red, green, blue; with a fourth, alpha
  bool deep = false;                  ///< two bytes a sample, the high one first
  std::vector<std::uint8_t> samples;  ///< of each pixel all channels, rows from the top
};

/// Whether the first bytes are those of the format.
[[nodiscard]] bool is_png(const std::string& bytes);
[[nodiscard]] bool is_jpeg(const std::string& bytes);

/// Decodes a PNG file (ISO/IEC 15948): grey, palette and colour, of any depth, interlaced or not. Its gamma
/// and colour profile are not applied. Throws InputError with `file` for damaged data.
[[nodiscard]] DecodedImage decode_png(const std::filesystem::path& file, const std::string& bytes);

/// Decodes a JPEG file (ISO/IEC 10918-1), grey or YCbCr. Throws InputError with `file` for damaged data and
/// for CMYK.
[[nodiscard]] DecodedImage decode_jpeg(const std::filesystem::path& file, const std::string& bytes);

/// Before memory is taken: refuses an image of more than 16384 pixels along an edge, of more than 2^26 in
/// all, and one whose file is too short, where no file of `bytes` bytes holds more than `pixels_per_byte`
/// each. Throws InputError with `file`.
void require_usable_size(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height,
                         std::size_t bytes, double pixels_per_byte);

/// That the data of an image are wrong. `what` is the decoder's reason.
[[noreturn]] void refuse_damaged_image(const std::filesystem::path& file, const std::string& what);

}  // namespace fluxel
