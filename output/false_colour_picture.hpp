#pragma once

#include <filesystem>

#include "output/output_table.hpp"

namespace fluxel {

/// The radiance of the run's picture, in heat runs the temperature of the
/// elements that it shows, in false colours with a legend.
[[nodiscard]] DisplayPicture false_colour_picture(const OutputSource& source);

/// Writes it as image-false-colour.png. Throws InputError where it cannot.
void write_false_colour_picture(const std::filesystem::path& file, const OutputSource& source);

}  // namespace fluxel
