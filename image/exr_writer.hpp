#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "image/layered_image.hpp"
#include "image/picture.hpp"

namespace fluxel {

/// Writes one OpenEXR file, ZIP-compressed, with the channels R, G, B (linear radiance [W/m2/sr]), depth.Z
/// [m], normal.X/Y/Z (world axes), reflectance.R/G/B and irradiance.R/G/B [W/m2] in 32-bit floats, and
/// element.id as unsigned integer (0xFFFFFFFF: nothing seen). `attributes` go into the header as strings. The
/// same picture and attributes give the same bytes. Throws InputError where the file cannot be written;
/// nothing then stands under its name. Throws what OpenEXR throws where an attribute has an empty name or
/// that of a part of the header.
void write_exr(const std::filesystem::path& file, const Picture& picture,
               const std::map<std::string, std::string>& attributes);

/// The same for layers of three colours: R, G, B, and NAME.R, NAME.G, NAME.B of each named one, in 32-bit
/// floats. Throws std::logic_error where a layer has not one value a pixel.
void write_exr(const std::filesystem::path& file, const LayeredImage& image,
               const std::map<std::string, std::string>& attributes);

}  // namespace fluxel
