#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mpi_master/steps/forecast.hpp"
#include "mpi_master/steps/form_factor_matrix.hpp"
#include "mpi_master/steps/visibility_job.hpp"
#include "solver/closure.hpp"

namespace fluxel {

/// How far the form factors' row sums are from what they should be.
struct FormFactorSums {
  double row_sum_max = 0;          ///< as the rules make them
  double closure_defect_rms = 0;   ///< area-weighted, from 1 less what leaves the scene
  std::optional<Closure> closure;  ///< how they were made that, where they were
};

/// What a run over all pairs has forecast and made.
struct MatrixStatistics {
  Forecast forecast;
  std::optional<VisibilityCounts> visibility;
  std::uint64_t visibility_hash = 0;
  std::uint32_t visibility_makers = kMadeByProcessor;  ///< of StripMaker
  ScheduleRecord visibility_schedule;
  int gpu_ranks = 0;
  std::vector<std::string> gpus;  ///< their names, each once
  std::optional<FormFactorStatistics> form_factors;
  GatherCounts gathered;  ///< of vectors from all hosts: form factors, preview and solve
};

}  // namespace fluxel
