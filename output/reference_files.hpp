#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/options.hpp"
#include "method/solution.hpp"
#include "metrics/phase_record.hpp"
#include "output/elements/element_file.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Writes what has been measured of one kind of sensor into the run's folder: reference.ply, for which
/// `elements` are those that were measured, reference.exr and reference.png, or receiver-NAME.exr. Returns
/// the file to name to the user. Throws InputError where it cannot.
[[nodiscard]] std::filesystem::path write_measured(const ReferenceOptions& options,
                                                   const FileElements& elements, const SensorLight& light);

/// All files that a reference may write.
[[nodiscard]] std::vector<std::filesystem::path> reference_outputs(const std::filesystem::path& folder,
                                                                   std::span<const Receiver> receivers);

/// What a reference cost beside its sensors.
struct ReferenceRun {
  int ranks = 1, threads = 1;
  double load_seconds = 0;
};

/// Writes tables and false-colour pictures of receivers, tasks.csv and convergence.csv, then reference.json:
/// how exact each kind of sensor has become, and at what cost.
void write_reference_report(const std::filesystem::path& folder, const ReferenceOptions& options,
                            const Scene& scene, const ReferenceRun& run, const Solution& solution,
                            const std::vector<PhaseRecord>& phases);

}  // namespace fluxel
