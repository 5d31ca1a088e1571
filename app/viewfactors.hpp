#pragma once

#include "core/options.hpp"
#include "core/progress.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Collective: `fluxel viewfactors`. Options and input matter on the root alone. Writes a row
/// `from,to,area_from_m2, view_factor,error_estimate` for every ordered pair of groups that exchange anything
/// and prints row sums and the reciprocity defect. Returns the exit code.
[[nodiscard]] int run_viewfactors(const Communicator& world, ViewFactorOptions options,
                                  const SceneInput& input, ProgressDisplay& display);

}  // namespace fluxel
