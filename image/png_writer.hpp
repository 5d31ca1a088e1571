#pragma once

#include <filesystem>
#include <string>

#include "image/tone_map.hpp"

namespace fluxel {

/// An 8-bit RGB PNG that says it is sRGB.
[[nodiscard]] std::string png_bytes(const DisplayPicture& picture);

/// Writes it. Throws InputError where the file cannot be written; nothing
/// then stands under its name.
void write_png(const std::filesystem::path& file, const DisplayPicture& picture);

}  // namespace fluxel
