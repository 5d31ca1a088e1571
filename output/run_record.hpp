#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "method/solution.hpp"
#include "metrics/phase_record.hpp"
#include "mpi_master/communication/machine.hpp"
#include "scene/scene.hpp"

namespace fluxel {

struct Options;

/// All that the files of a run are made of, on the root.
struct RunRecord {
  const Options& options;
  const Scene& scene;
  const Solution& solution;
  const std::vector<RankPlace>& places;
  const std::vector<PhaseRecord>& phases;  ///< with their forecasts
  const std::vector<std::string>& warnings;
  PhaseTimes time = {};          ///< wall clock of this rank, processor time of all
  std::uint64_t peak_bytes = 0;  ///< of the largest rank
};

}  // namespace fluxel
