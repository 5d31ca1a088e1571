#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/energy.hpp"
#include "app/hierarchy_facts.hpp"
#include "app/stopwatch.hpp"
#include "app/thermal.hpp"
#include "core/options.hpp"
#include "metrics/phase_record.hpp"
#include "mpi_master/checkpoint.hpp"
#include "mpi_master/forecast.hpp"
#include "mpi_master/form_factor_matrix.hpp"
#include "mpi_master/machine.hpp"
#include "mpi_master/visibility_job.hpp"
#include "scene/scene.hpp"
#include "solver/error_bound.hpp"
#include "solver/iterate.hpp"
#include "solver/refinement_error.hpp"

namespace fluxel {

/// Of the phases.
struct PhaseTimes {
  PhaseTime load, subdivision, forecast, visibility, form_factors, preview, solve, gather, image, estimate,
      total;
};

/// How far the solution is from the true radiosity, as coarser meshes tell.
struct ErrorEstimate {
  std::string why_none;               ///< empty: there is one
  std::vector<std::size_t> elements;  ///< of the run's mesh and of those coarser than it
  RefinementError discretisation;
};

/// Everything that report.json says, gathered along the main path. What a run did not come to stays unset.
struct RunReport {
  Options options;
  std::vector<RankPlace> places;
  SceneFacts facts;
  std::size_t patches = 0, pieces = 0, materials = 0, emitters = 0;
  Rgb emitted_power{0};                ///< [W]
  std::array<glm::dvec3, 2> bounds{};  ///< lowest and highest coordinates [m, world]
  std::size_t elements = 0, unknowns = 0;
  int deepest = 0;
  double max_edge = 0;
  std::uint64_t elements_hash = 0;
  Forecast forecast;
  std::optional<VisibilityCounts> visibility;
  std::uint64_t visibility_hash = 0;
  std::uint32_t visibility_makers = kMadeByProcessor;  ///< of StripMaker
  int gpu_ranks = 0;
  std::vector<std::string> gpus;  ///< their names, each once
  std::optional<CheckpointCounts> checkpoint;
  DealtTiles visibility_dealt;
  RowSums row_sums;  ///< of the matrix as it is solved
  FormFactorFacts form_factors;
  std::optional<bool> closed;  ///< no ray escapes from any unknown side
  std::optional<Radiosity> radiosity;
  std::optional<HierarchyFacts> hierarchy;  ///< of hierarchical runs
  EnergyBalance energy;
  std::vector<ThermalRow> thermal;  ///< of thermal runs
  GatherCounts gathered;            ///< of vectors from all nodes: form factors, preview and solve
  std::string solver_reason;        ///< of Solver::automatic
  std::string instruction_set;
  std::optional<double> exposure;
  PhaseTimes time;                  ///< of this rank; once written, processor times are those of all ranks
  std::uint64_t peak_bytes = 0;     ///< of the largest rank
  std::uint64_t held_bytes = 0;     ///< by all ranks at the end of the solve, what they share counted once
  std::vector<PhaseRecord> phases;  ///< with their forecasts, on the root
  std::optional<ErrorEstimate> error_estimate;  ///< on the root
  std::vector<std::string> notes, warnings;
};

/// Writes report.json; throws InputError where it cannot.
void write_report(const std::filesystem::path& file, const RunReport& report);

}  // namespace fluxel
