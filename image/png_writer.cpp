#include "image/png_writer.hpp"

#include <png.h>

#include <stdexcept>
#include <string>

#include "core/file.hpp"

namespace fluxel {

std::string png_bytes(const DisplayPicture& picture) {
  // libpng's simplified interface keeps its longjmp inside; it marks 8-bit RGB as sRGB.
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;

  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("PNG encoder: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

void write_png(const std::filesystem::path& file, const DisplayPicture& picture) {
  write_bytes_atomically(file, png_bytes(picture));
}

}  // namespace fluxel
