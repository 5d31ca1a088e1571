#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/output_table.hpp"
#include "output/run_record.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Makes the run's folder, and throws InputError where it or one of the files cannot be written to, or where
/// one of them, or of those that --checkpoint replaces, is one of the files that were read.
void require_outputs(const Options& options, const SceneInput& input);

/// Whether radiosity and irradiance are finite in single precision; else neither picture nor solution is
/// written.
[[nodiscard]] bool can_be_written(const Solution& solution);

/// Makes the picture, where there is a camera, and that of the light map, where there is one, if the solution
/// can be written.
void make_pictures_of(OutputSource& source);

/// Writes all files of the table that are written at this time and wanted. A run that ended before its
/// solution writes what it has: its report, and convergence.csv where it worked. Throws InputError where a
/// file cannot be written.
void write_outputs(OutputTime when, const OutputSource& source);

/// The files in the folder, the report aside, that this run does not write: they are an earlier run's.
[[nodiscard]] std::vector<std::filesystem::path> stale_outputs(const RunRecord& record);

/// Removes early pictures of earlier runs.
void remove_early_pictures(const std::filesystem::path& folder);

/// Throws InputError where a file cannot be removed.
void remove_outputs(const std::vector<std::filesystem::path>& files);

}  // namespace fluxel
