#include "scene/readers/decoded_image.hpp"

#include <fmt/format.h>

#include "core/input_error_at.hpp"

namespace fluxel {
namespace {

constexpr std::uint64_t kMaxEdge = 16384;
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 26;  // at most 8 bytes each, and sums of rows

}  // namespace

bool is_png(const std::string& bytes) { return bytes.starts_with("\x89PNG\r\n\x1A\n"); }

bool is_jpeg(const std::string& bytes) { return bytes.starts_with("\xFF\xD8\xFF"); }

void require_usable_size(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height,
                         std::size_t bytes, double pixels_per_byte) {
  if (width > kMaxEdge || height > kMaxEdge || width * height > kMaxPixels) {
    throw input_error_at(file, 0, fmt::format("an image of {} x {} pixels is too large", width, height),
                         fmt::format("at most {} along an edge and {} in all: make it smaller, only its mean "
                                     "over each face is used",
                                     kMaxEdge, kMaxPixels));
  }
  const auto pixels = static_cast<double>(width * height);
  if (pixels > static_cast<double>(bytes) * pixels_per_byte) {
    refuse_damaged_image(file, fmt::format("{} bytes are too few for {} x {} pixels", bytes, width, height));
  }
}

void refuse_damaged_image(const std::filesystem::path& file, const std::string& what) {
  throw input_error_at(file, 0, fmt::format("the image is damaged: {}", what),
                       "save it again, as PNG or JPEG");
}

}  // namespace fluxel
