#pragma once

#include "core/options.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// How the run's options make a scene, by so many threads.
[[nodiscard]] SceneSettings scene_settings(const Options& options, int threads);

/// Collective: builds the scene of a run that computes light or heat, by the root's threads, for everybody.
/// Throws AgreedError where there is nothing to compute or nothing emits. `progress`, of a phase that has
/// begun, is reported to where building takes long.
[[nodiscard]] Scene load_scene(const Communicator& world, const Options& options, int threads,
                               const SceneInput& input, Progress* progress = nullptr);

}  // namespace fluxel
