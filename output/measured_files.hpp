#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "image/tone_map.hpp"
#include "method/solution.hpp"
#include "output/elements/element_file.hpp"
#include "output/json_parts.hpp"
#include "scene/scene.hpp"

namespace fluxel {

struct Options;

/// A run whose sensors have files of their own.
struct MeasuredRun {
  const Options& options;
  std::string stem;  ///< of its files
  std::uint64_t seed = 0;
};

/// Writes what has been measured of one kind of sensor into the run's folder: STEM.ply, for which `elements`
/// are those that were measured, STEM.exr and STEM.png, or receiver-NAME.exr. Returns the file to name to the
/// user. Throws InputError where it cannot.
[[nodiscard]] std::filesystem::path write_measured(const MeasuredRun& run, const FileElements& elements,
                                                   const SensorLight& light);

/// A picture as it is shown.
[[nodiscard]] DisplayPicture display_of(const MeasuredRun& run, const SensorLight& light);

/// All files that such a run may write, its report STEM.json among them.
[[nodiscard]] std::vector<std::filesystem::path> measured_outputs(const std::filesystem::path& folder,
                                                                  const std::string& stem,
                                                                  std::span<const Receiver> receivers);

/// Writes tables and false-colour pictures of receivers, and tasks.csv; adds what they come to to the
/// report's `measured` and `tasks`, and the observers' glare.
void write_meters(const MeasuredRun& run, const Scene& scene, const Solution& solution, Json& report);

}  // namespace fluxel
