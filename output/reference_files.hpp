#pragma once

#include <filesystem>
#include <vector>

#include "core/options.hpp"
#include "method/solution.hpp"
#include "metrics/phase_record.hpp"
#include "output/measured_files.hpp"
#include "scene/scene.hpp"

namespace fluxel {

struct ReferenceOptions;

/// The files of `fluxel reference`.
[[nodiscard]] inline MeasuredRun measured_run(const ReferenceOptions& options) {
  return {options.run, "reference", options.seed};
}

/// What a measurement cost beside its sensors.
struct MeasuredCost {
  int ranks = 1, threads = 1;
  double load_seconds = 0;
};

/// Writes tables and false-colour pictures of receivers, tasks.csv and convergence.csv, then reference.json
/// and reference.html: how exact each kind of sensor has become, and at what cost.
void write_reference_report(const ReferenceOptions& options, const Scene& scene, const MeasuredCost& cost,
                            const Solution& solution, const FileElements& elements,
                            const std::vector<PhaseRecord>& phases);

}  // namespace fluxel
