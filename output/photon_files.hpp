#pragma once

#include <filesystem>
#include <vector>

#include "core/options.hpp"
#include "method/solution.hpp"
#include "metrics/phase_record.hpp"
#include "output/reference_files.hpp"
#include "scene/scene.hpp"

namespace fluxel {

struct PhotonOptions;

/// The files of `fluxel photons`.
[[nodiscard]] inline MeasuredRun measured_run(const PhotonOptions& options) {
  return {options.run, "photons", options.seed};
}

/// What keeps what photons have brought, in the folder of checkpoints or else of the run.
[[nodiscard]] std::filesystem::path tally_path(const PhotonOptions& options);

/// Writes tables and false-colour pictures of receivers, tasks.csv and convergence.csv, then photons.json and
/// photons.html: how exact elements and receivers have become, where the light has gone, and at what cost.
void write_photon_report(const PhotonOptions& options, const Scene& scene, const MeasuredCost& cost,
                         const Solution& solution, const FileElements& elements,
                         const std::vector<PhaseRecord>& phases);

}  // namespace fluxel
