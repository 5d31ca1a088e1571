#pragma once

#include <filesystem>

#include "output/output_table.hpp"

namespace fluxel {

/// Writes image-false-colour.png: the radiance of the run's picture, in heat runs the temperature of the
/// elements that it shows, in false colours with a legend. Throws InputError where it cannot.
void write_false_colour_picture(const std::filesystem::path& file, const OutputSource& source);

}  // namespace fluxel
