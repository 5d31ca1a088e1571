#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hierarchy/hierarchy.hpp"
#include "hierarchy/hierarchy_round.hpp"
#include "method/run_limit.hpp"
#include "metrics/round_forecast.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Estimated errors of the result, root mean square over the mean.
struct HierarchyErrors {
  std::optional<double> discretisation;  ///< of nodes and links; none after a single round
  std::optional<double> rays;            ///< of the rays that the probes ask; none without probes
  std::optional<double> picture;         ///< as rays, of pixels that were gathered together, as measured
  double iteration = 0;                  ///< a bound
};

/// What would follow after a dry run's rounds.
struct HierarchyForecast {
  std::size_t rounds = 0;
  RoundSample last;          ///< of them; its seconds are those of all
  double audit_seconds = 0;  ///< of its share of the work
  double picture_seconds = 0;
};

/// What a hierarchical run has made and chosen.
struct HierarchyStatistics {
  bool by_rays = false;  ///< how nodes exchange light; else by links
  std::vector<HierarchyRound> rounds;
  std::size_t rounds_resumed = 0;  ///< the first ones, of an earlier run
  HierarchyErrors errors;
  /// Root mean square over the mean that the error is below with a chance of nine in ten; none where nothing
  /// is known.
  std::optional<double> stated;
  double ray_error = 0;              ///< of GatherGoal, as it was chosen
  double tolerance = 0;              ///< of the solver
  std::optional<bool> reached;       ///< the target, where there is one
  std::optional<RunLimit> ended_by;  ///< what has ended the rounds before their goal
  std::uint64_t bytes = 0;           ///< of the largest rank's tree and links
  std::uint64_t pairs = 0;           ///< of nodes that were looked at, by all ranks
  std::uint64_t shafts = 0, contours = 0, rays = 0, gather_rays = 0;
  std::optional<HierarchyForecast> forecast;  ///< of a dry run
};

/// Collective: what all ranks have counted, into the statistics.
void sum_counts(const Communicator& world, const Hierarchy& hierarchy, HierarchyStatistics& statistics);

/// What nodes exchange light by, as "120 links between 40 nodes".
[[nodiscard]] std::string exchange_text(const HierarchyRound& round);

}  // namespace fluxel
