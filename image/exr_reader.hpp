#pragma once

#include <filesystem>
#include <string>

#include "image/layered_image.hpp"

namespace fluxel {

/// Longest side of a picture that is read [pixels].
inline constexpr int kLongestSide = 65536;

/// Reads an OpenEXR file of scan lines, whoever wrote it: R, G, B as the layer without a name, and each layer
/// NAME with channels NAME.R, NAME.G, NAME.B; other channels are left out. Values are half or single
/// precision; the data window is what counts. Throws InputError for no file, one that is damaged, tiled, deep
/// or of several parts, lacks R, G or B, has a layer with some of them only, is larger than kLongestSide or
/// holds values that are not finite.
[[nodiscard]] LayeredImage read_exr(const std::filesystem::path& file);

/// The same from the file's bytes.
[[nodiscard]] LayeredImage exr_of_bytes(const std::filesystem::path& file, const std::string& bytes);

}  // namespace fluxel
