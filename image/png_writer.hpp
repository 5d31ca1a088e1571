#pragma once

#include <filesystem>

#include "image/tone_map.hpp"

namespace fluxel {

/// Writes an 8-bit RGB PNG that says it is sRGB. Throws InputError where the file cannot be written; nothing
/// then stands under its name.
void write_png(const std::filesystem::path& file, const DisplayPicture& picture);

}  // namespace fluxel
