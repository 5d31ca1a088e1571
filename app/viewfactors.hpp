#pragma once

#include "core/options.hpp"
#include "core/progress.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Collective: `fluxel viewfactors`. Options and input matter on the root alone. Writes a row for every
/// ordered pair of sides of groups that exchange anything (output/view_factor_file.hpp), the files of sides
/// of patches that are asked for (output/face_factor_files.hpp), and prints row sums and the reciprocity
/// defect of groups. Returns the exit code.
[[nodiscard]] int run_viewfactors(const Communicator& world, ViewFactorOptions options,
                                  const SceneInput& input, ProgressDisplay& display);

}  // namespace fluxel
