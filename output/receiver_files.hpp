#pragma once

#include <filesystem>
#include <string>

#include "image/exr_writer.hpp"
#include "output/run_record.hpp"

namespace fluxel {

/// Layers of what was measured, by the names that compare knows.
[[nodiscard]] LayeredImage layers_of(const SensorLight& light);

/// receiver-NAME.exr
[[nodiscard]] std::string receiver_file(const SensorLight& light);

/// Writes receiver-NAME.exr for each receiver: irradiance [W/m2] of every cell, row 0 at the top, and its
/// estimated error, that of the gather's rays and, where it is known, that of the solution together. Throws
/// InputError where it cannot.
void write_receiver_pictures(const std::filesystem::path& folder, const RunRecord& record);

/// Writes the same as a table: a line a cell, with the cell's centre [m, world].
void write_receiver_table(const std::filesystem::path& file, const RunRecord& record);

}  // namespace fluxel
