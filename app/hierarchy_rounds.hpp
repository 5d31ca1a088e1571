#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/describe.hpp"
#include "app/report.hpp"
#include "core/progress.hpp"
#include "hierarchy/hierarchy.hpp"
#include "mpi_master/communicator.hpp"
#include "mpi_master/round_folder.hpp"

namespace fluxel {

/// What is asked of the rounds.
struct RoundsGoal {
  double target = 0;  ///< of HierarchyErrors::all; 0: `block_error` is what counts
  double block_error = 0;
  std::uint64_t bytes = 0;  ///< that a rank's tree and blocks may take
};

/// Collective: refines and solves in turn, from coarse to fine, until the estimated error is the target's or
/// the memory is used up. `probes` are points at whose radiosity the error is looked at; none: it is looked
/// at everywhere. Every round is kept in `folder`, from where --resume goes on.
void run_rounds(const Communicator& world, Hierarchy& hierarchy, std::span<const GatherPoint> probes,
                const RoundsGoal& goal, RoundFolder& folder, const Teller& teller, Progress& progress,
                RunReport& report);

}  // namespace fluxel
