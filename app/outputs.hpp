#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include "app/report.hpp"
#include "core/raster.hpp"
#include "mpi_master/subdivision_job.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Names of all files that a run may write; report.json is the last.
inline constexpr std::array kOutputs{"image.exr",      "image.png",      "preview-1s.png", "preview-2s.png",
                                     "preview-4s.png", "preview-8s.png", "solution.ply",   "convergence.csv",
                                     "thermal.csv",    "timeline.csv",   "report.json"};

/// Early pictures, of 2^k seconds.
inline constexpr std::array kPreviews{kOutputs[2], kOutputs[3], kOutputs[4], kOutputs[5]};

/// Makes the run's folder, and throws InputError where it or one of the files cannot be written to, or where
/// one of them, or of those that --checkpoint replaces, is one of the inputs.
void require_outputs(const Options& options, std::span<const std::filesystem::path> inputs);

/// Writes image.exr and image.png (with a camera) and solution.ply, of thermal runs also thermal.csv, into
/// the run's folder, and adds what it chose to the report. `irradiance` as for make_picture. False: nothing
/// is written, since the solution is not finite in single precision. Throws InputError where a file cannot be
/// written.
[[nodiscard]] bool write_outputs(const Scene& scene, const SubdividedScene& subdivided,
                                 std::span<const Rgb> irradiance, RunReport& report);

/// Writes the picture of an early radiosity (an entry an unknown). Throws InputError where it cannot.
void write_preview(const std::filesystem::path& file, const Scene& scene, const SubdividedScene& subdivided,
                   std::span<const Rgb> B, const RunReport& report);

/// The files in the folder, the report aside, that a run with these options does not write, or, of pictures
/// and solution, has not `written`: they are an earlier run's.
[[nodiscard]] std::vector<std::filesystem::path> stale_outputs(const Options& options, bool written);

/// Throws InputError where a file cannot be removed.
void remove_outputs(const std::vector<std::filesystem::path>& files);

}  // namespace fluxel
