#pragma once

#include "core/options.hpp"
#include "core/progress.hpp"
#include "mpi_master/communicator.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Collective: the whole job. `input` is read on the root alone. Returns the exit code, 0 or 3.
/// Throws AgreedError on all ranks for bad input; anything else is thrown by the rank that failed.
int run_solve(const Communicator& world, Options options, const SceneInput& input, Progress& progress);

}  // namespace fluxel
